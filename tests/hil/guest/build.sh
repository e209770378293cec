#!/bin/bash
# build.sh OUT: makes the guest without our package: Debian of this machine's own release with its
# PREEMPT_RT kernel, the modules v4l2loopback and gpio-sim, and systemd. Needs no root rights, installs
# nothing; mirror and release come from apt's configuration. Into OUT: vmlinux, initrd, base.ext4.
# What is there already stays, as long as this script has not changed (OUT/stamp).
set -euo pipefail
export LC_ALL=C
here=$(cd "$(dirname "$0")" && pwd)
mkdir -p "$1"
out=$(cd "$1" && pwd)
stamp=$(cat "$here"/build.sh "$here"/init "$here"/units/* | sha256sum | cut -c1-16)
[ "$(cat "$out/stamp" 2>/dev/null)" != "$stamp" ] || exit 0
rm -f "$out/stamp"

suite=$(. /etc/os-release && echo "$VERSION_CODENAME")
say() { echo "  HIL   $*"; }
# apt drops to the user _apt for downloads, who may not write here.
download() { apt-get -qq $([ "$(id -u)" != 0 ] || echo -o APT::Sandbox::User=root) download "$@"; }
depends() { apt-cache depends "$1" | awk '/Depends:/ {print $2}'; }

# ---- kernel, headers, sources ---------------------------------------------------------------------
image=$(depends linux-image-rt-amd64 | grep -m1 '^linux-image-')
release=${image#linux-image-}
kernel=$out/kernel
if [ "$(cat "$kernel/release" 2>/dev/null)" != "$release" ]; then
  say "kernel $release"
  rm -rf "$kernel"
  mkdir -p "$kernel/debs"
  headers=linux-headers-$release
  # shellcheck disable=SC2046
  (cd "$kernel/debs" && download "$image" "$headers" \
    $(depends "$headers" | grep -E '^linux-(headers|kbuild)-') \
    "$(depends linux-source | grep -m1 '^linux-source-')" v4l2loopback-dkms)
  for deb in "$kernel"/debs/*.deb; do dpkg-deb -x "$deb" "$kernel"; done
  rm -r "$kernel/debs"
  # The headers expect to lie in the root folder.
  sed -i "s,/usr/src,$kernel/usr/src,g" "$kernel/usr/src/linux-headers-$release/Makefile"
  sed -i 's/gcc-[0-9]*/gcc/' "$kernel/usr/src/linux-headers-$release/.kernelvariables"

  say "modules v4l2loopback, gpio-sim"
  build_module() {
    make -s -C "$kernel/usr/src/linux-headers-$release" M="$1" modules >"$1/log" 2>&1 ||
      { cat "$1/log" >&2; exit 1; }
    install -D -m 644 -t "$kernel/lib/modules/$release/extra" "$1"/*.ko
  }
  mkdir -p "$kernel/v4l2loopback" "$kernel/gpio-sim"
  cp "$kernel"/usr/src/v4l2loopback-*/*.[ch] "$kernel/v4l2loopback"
  echo 'obj-m := v4l2loopback.o' >"$kernel/v4l2loopback/Kbuild"
  build_module "$kernel/v4l2loopback"
  tar -xJf "$kernel"/usr/src/linux-source-*.tar.xz --strip-components=3 -C "$kernel/gpio-sim" \
    --wildcards --occurrence=1 'linux-source-*/drivers/gpio/gpio-sim.c' \
    'linux-source-*/drivers/gpio/gpiolib.h' 'linux-source-*/kernel/irq/irq_sim.c'
  rm "$kernel"/usr/src/linux-source-*.tar.xz
  # Out of the tree irq_to_desc is not exported; and the first pending line is wanted, not the next.
  sed -i -e 's/handle_simple_irq(irq_to_desc(irqnum))/generic_handle_irq(irqnum)/' \
    -e '/find_next_bit(/{N;s/find_next_bit(\(.*\), offset)/find_first_bit(\1)/}' "$kernel/gpio-sim/irq_sim.c"
  ! grep -nE 'irq_to_desc|find_next_bit' "$kernel/gpio-sim/irq_sim.c" ||
    { echo "hil: irq_sim.c has changed: mend build.sh" >&2; exit 1; }
  mv "$kernel/gpio-sim/gpio-sim.c" "$kernel/gpio-sim/gpio-sim-main.c"
  # shellcheck disable=SC2016
  printf '%s\n' 'obj-m := gpio-sim.o' 'gpio-sim-y := gpio-sim-main.o irq_sim.o' 'ccflags-y := -I$(src)' \
    >"$kernel/gpio-sim/Kbuild"
  build_module "$kernel/gpio-sim"
  /sbin/depmod -b "$kernel" "$release"

  # Unpacked: saves the guest three seconds at each start.
  at=$(grep -abo -m1 -P '\xfd7zXZ\x00' "$kernel/boot/vmlinuz-$release" | head -n1 | cut -d: -f1)
  tail -c "+$((at + 1))" "$kernel/boot/vmlinuz-$release" | xz -dc --single-stream 2>/dev/null \
    >"$kernel/vmlinux" || [ -s "$kernel/vmlinux" ]
  echo "$release" >"$kernel/release"
fi
cp "$kernel/vmlinux" "$out/vmlinux"

# ---- emulator: 10 or later ---------------------------------------------------------------------------
# Before, AVX2's gathers read wrong places, and icount starved a second processor. Where the machine
# has an older one, Debian's backport is unpacked beside it, on the libraries that are installed.
qemu=$(command -v qemu-system-x86_64)
if [ "$("$qemu" --version | sed -n 's/.* version \([0-9]*\).*/\1/p')" -lt 10 ]; then
  if [ ! -x "$out/qemu/usr/bin/qemu-system-x86_64" ]; then
    say "QEMU 10, unpacked"
    rm -rf "$out/qemu" "$out/backports"
    mkdir -p "$out/qemu" "$out"/backports/{lists/partial,cache/archives/partial}
    apt-get indextargets --format 'deb $(REPO_URI) $(RELEASE)-backports main' 'Created-By: Packages' \
      'Origin: Debian' | grep -m1 " $suite-backports " >"$out/backports/sources.list"
    beside="-o Dir::Etc::sourcelist=$out/backports/sources.list -o Dir::Etc::sourceparts=-
      -o Dir::State::lists=$out/backports/lists -o Dir::Cache=$out/backports/cache"
    # shellcheck disable=SC2086
    apt-get -qq $beside update
    # shellcheck disable=SC2086
    (cd "$out/backports" && download $beside qemu-system-x86 qemu-system-common qemu-system-data seabios)
    for deb in "$out"/backports/*.deb; do dpkg-deb -x "$deb" "$out/qemu"; done
    rm -r "$out/backports"
  fi
  qemu="$out/qemu/usr/bin/qemu-system-x86_64 -L $out/qemu/usr/share/qemu -L $out/qemu/usr/share/seabios"
fi
echo "$qemu" >"$out/qemu.command"

modules_of() {  # paths of the modules named, with what they need, in order
  for name; do /sbin/modprobe -d "$kernel" -S "$release" --show-depends "$name"; done |
    awk '$1 == "insmod" && !seen[$2]++ {print $2}'
}

# ---- initrd: only what mounts the root -------------------------------------------------------------
say initrd
initrd=$out/initrd.d
rm -rf "$initrd"
mkdir -p "$initrd"/{bin,modules,proc,sys,dev,root}
cp /bin/busybox "$initrd/bin/busybox"
cp "$here/init" "$initrd/init"
chmod 755 "$initrd/init"
number=10
for module in $(modules_of libnvdimm nfit nd_btt nd_pmem ext4 crc32c_generic); do
  cp "$module" "$initrd/modules/$number-$(basename "$module")"
  number=$((number + 1))
done
(cd "$initrd" && find . | sort | cpio --quiet -o -H newc -R 0:0 --reproducible) >"$out/initrd"
rm -r "$initrd"

# ---- root ---------------------------------------------------------------------------------------
if [ ! -s "$out/rootfs.tar" ]; then
  say "root file system"
  # All of Debian's archives that this machine uses for its own release, as apt knows them.
  apt-get indextargets --format 'deb $(REPO_URI) $(RELEASE) $(COMPONENT)' 'Created-By: Packages' \
    'Origin: Debian' | grep -E " $suite(-updates|-security)? " >"$out/sources.list"
  mmdebstrap --quiet --variant=minbase --dpkgopt='path-exclude=/usr/share/doc/*' \
    --dpkgopt='path-exclude=/usr/share/man/*' --dpkgopt='path-exclude=/usr/share/locale/*' \
    --dpkgopt='path-exclude=/usr/share/info/*' --include="$(echo systemd systemd-sysv udev kmod \
      iproute2 can-utils gpiod libgpiod2 v4l-utils rt-tests procps util-linux dbus libstdc++6 \
      libpng16-16 libturbojpeg0 jq tcpdump | tr ' ' ,)" \
    "$suite" "$out/rootfs.part.tar" "$out/sources.list" || { cat "$out/sources.list" >&2; exit 1; }
  mv "$out/rootfs.part.tar" "$out/rootfs.tar"
fi

say "base image"
as_root=
[ "$(id -u)" = 0 ] || as_root=fakeroot
rm -rf "$out/root"
mkdir "$out/root"
export here out kernel release
MODULES=$(modules_of vcan can-raw can-dev sch_plug vivid videodev configfs v4l2loopback gpio-sim)
export MODULES
$as_root bash -euc '
  tar -xf "$out/rootfs.tar" -C "$out/root" --exclude "./dev/*"
  cd "$out/root"
  for module in $MODULES; do
    install -D -m 644 "$module" "lib/modules/$release/${module##*/lib/modules/$release/}"
  done
  cp "$kernel/lib/modules/$release"/modules.{builtin,builtin.modinfo,order} "lib/modules/$release/"
  /sbin/depmod -b . "$release"
  echo hil >etc/hostname
  echo 0123456789abcdef0123456789abcdef >etc/machine-id   # else the first start presets all units
  mkdir -p etc/systemd/journald.conf.d hil
  printf "[Journal]\nStorage=volatile\nRateLimitIntervalSec=0\n" >etc/systemd/journald.conf.d/hil.conf
  install -m 644 "$here"/units/*.service etc/systemd/system
  mkdir -p etc/systemd/system/basic.target.wants
  ln -sf /etc/systemd/system/hil.service etc/systemd/system/multi-user.target.wants/hil.service
  ln -sf /lib/systemd/system/multi-user.target etc/systemd/system/default.target
  # Of no use here, and each costs virtual time at every start.
  for unit in getty.target getty@.service serial-getty@.service apt-daily.timer \
      apt-daily-upgrade.timer fstrim.timer e2scrub_all.timer e2scrub_reap.service dpkg-db-backup.timer \
      systemd-timesyncd.service proc-sys-fs-binfmt_misc.automount systemd-binfmt.service \
      systemd-update-utmp.service systemd-update-utmp-runlevel.service systemd-hwdb-update.service \
      systemd-journal-catalog-update.service systemd-journal-flush.service systemd-random-seed.service \
      systemd-firstboot.service systemd-update-done.service \
      systemd-user-sessions.service modprobe@.service systemd-repart.service \
      systemd-pcrphase.service systemd-pcrphase-sysinit.service systemd-pcrphase-initrd.service \
      systemd-pcrmachine.service systemd-boot-system-token.service systemd-machine-id-commit.service \
      systemd-pstore.service systemd-network-generator.service systemd-ask-password-wall.path \
      systemd-ask-password-console.path systemd-tmpfiles-clean.timer motd-news.timer \
      dev-hugepages.mount sys-kernel-debug.mount sys-kernel-tracing.mount sys-fs-fuse-connections.mount \
      systemd-logind.service systemd-rfkill.socket remote-fs.target; do
    ln -sf /dev/null "etc/systemd/system/$unit"
  done
  rm -rf var/cache/apt/* var/lib/apt/lists/*
  truncate -s 0 "$out/base.ext4.part"
  /sbin/mke2fs -q -F -t ext4 -O "^metadata_csum,^64bit" -m 0 -U 11111111-2222-3333-4444-555555555555 \
    -E hash_seed=11111111-2222-3333-4444-555555555555 -d . "$out/base.ext4.part" 700M
'
rm -rf "$out/root"
mv "$out/base.ext4.part" "$out/base.ext4"
echo "$stamp" >"$out/stamp"
