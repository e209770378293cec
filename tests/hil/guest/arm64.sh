#!/bin/bash
# arm64.sh OUT GUEST: makes the small ARM64 guest: Debian's PREEMPT_RT kernel for arm64, the modules cross
# built from the sources that build.sh has left in GUEST, and an initramfs of Debian's own programs.
# Nothing is installed. Into OUT: vmlinuz, modules/, tree/.
set -euo pipefail
export LC_ALL=C
here=$(cd "$(dirname "$0")" && pwd)
out=$1 guest=$(cd "$2" && pwd)
foreign=aarch64-linux-gnu
release=$(sed 's/amd64$/arm64/' "$guest/kernel/release")
"$here/../../../systemd/deb/sysroot.sh" arm64 "$out" "linux-image-$release" "linux-headers-$release" \
  busybox-static can-utils gpiod v4l-utils kmod iproute2 rt-tests libpng16-16 libturbojpeg0 libgpiod2 libstdc++6
[ ! -e "$out/modules/complete" ] || exit 0
out=$(cd "$out" && pwd)
tree=$out/tree
echo "  HIL   arm64: modules for $release"
headers=$tree/usr/src/linux-headers-$release
sed -i "s,include .*/usr/src/,include $guest/kernel/usr/src/," "$headers/Makefile"
sed -i 's/gcc-[0-9]*/gcc/' "$headers/.kernelvariables"
# The tools of the build run here, not there.
rm -rf "$tree"/usr/lib/linux-kbuild-*
ln -s "$guest"/kernel/usr/lib/linux-kbuild-* "$tree/usr/lib"
mkdir -p "$out/modules"
for module in v4l2loopback gpio-sim; do
  rm -rf "$out/$module"
  mkdir "$out/$module"
  cp "$guest/kernel/$module"/*.[ch] "$guest/kernel/$module/Kbuild" "$out/$module"
  rm -f "$out/$module"/*.mod.c
  make -s -C "$headers" M="$out/$module" ARCH=arm64 CROSS_COMPILE=$foreign- modules >"$out/$module/log" 2>&1 ||
    { cat "$out/$module/log" >&2; exit 1; }
  install -D -m 644 -t "$tree/lib/modules/$release/extra" "$out/$module"/*.ko
done
/sbin/depmod -b "$tree" "$release"
for name in vcan can-raw videodev configfs v4l2loopback gpio-sim; do
  /sbin/modprobe -d "$tree" -S "$release" --show-depends "$name"
done | awk '$1 == "insmod" && !seen[$2]++ {printf "%02d %s\n", ++n, $2}' |
  while read -r number path; do cp "$path" "$out/modules/$number-$(basename "$path")"; done
cp "$tree/boot/vmlinuz-$release" "$out/vmlinuz"
touch "$out/modules/complete"
