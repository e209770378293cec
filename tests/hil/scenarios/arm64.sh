# The vehicle's architecture: the NEON kernels against scalar bit by bit, vcan, gpio-sim, v4l2loopback,
# and the cross-built package's programs, on Debian's arm64 PREEMPT_RT kernel.
OWN_MACHINE=1
skip() {
  command -v qemu-system-aarch64 aarch64-linux-gnu-g++ >/dev/null ||
    { echo "needs qemu-system-arm and g++-aarch64-linux-gnu"; return; }
  ls "$(git rev-parse --show-toplevel)"/build/deb/gannet_*_arm64.deb >/dev/null 2>&1 || echo "needs make deb-arm64"
}
machine() {  # SEED RESULTS
  local out=$cache/arm64 root=$2/root foreign=aarch64-linux-gnu
  "$here/guest/arm64.sh" "$out" "$cache" || return 1
  [ -x build/arm64/kernels_test ] || tests/support/arm64.sh $foreign >/dev/null || return 1
  mkdir -p "$root"/{bin,usr/bin,modules,etc/gannet,sbin}
  dpkg-deb -x "$(ls build/deb/gannet_*_arm64.deb | tail -n1)" "$root"
  cp "$here/guest/arm64-init" "$root/init"
  chmod 755 "$root/init"
  cp build/arm64/kernels_test "$root/usr/bin"
  cp "$out/tree/bin/busybox" "$root/bin"
  cp "$out"/modules/*.ko "$root/modules"
  local program
  for program in usr/bin/candump usr/bin/cansend usr/bin/gpiomon usr/bin/gpiofind usr/bin/cyclictest bin/ip; do
    cp -L "$out/tree/$program" "$root/usr/bin"
  done
  libraries "$out/tree" "$root"
  printf 'format = 1\nrgi = "x"\n' >"$root/etc/gannet/broken.toml"
  printf 'format = 1\nrig = "/usr/share/doc/gannet/examples/rig.toml"\n[can]\nkind = "memory"\n' >"$root/etc/gannet/gannet.toml"
  (cd "$root" && find . | sort | cpio --quiet -o -H newc -R 0:0 --reproducible | gzip -1) >"$2/initrd"
  rm -r "$root"
  timeout --foreground "${HOST_LIMIT_S:-1200}" qemu-system-aarch64 -accel tcg,thread=single -icount shift=0,sleep=off \
    -seed "$1" -M virt,gic-version=3 -cpu cortex-a72 -m 1024 -nodefaults -display none -no-reboot \
    -kernel "$out/vmlinuz" -initrd "$2/initrd" -append "console=ttyAMA0 quiet panic=-1" -serial "file:$2/console"
  rm "$2/initrd"
  tr -d '\r' <"$2/console" | grep '^RESULT ' >"$2/results"
  echo 0 >"$2/rc"
}
# The libraries that the programs below ROOT need, from TREE, and theirs.
libraries() {
  local name path foreign=aarch64-linux-gnu found=1
  mkdir -p "$2/lib/$foreign" "$2/usr/lib/$foreign"
  cp -L "$1/lib/ld-linux-aarch64.so.1" "$2/lib"
  while [ $found = 1 ]; do
    found=0
    for name in $(find "$2/usr/bin" "$2/lib" "$2/usr/lib" -type f -exec $foreign-readelf -d {} + 2>/dev/null |
        sed -n 's/.*(NEEDED).*\[\(.*\)\]/\1/p' | sort -u); do
      [ ! -e "$2/lib/$foreign/$name" ] || continue
      path=$(find "$1/lib/$foreign" "$1/usr/lib/$foreign" -name "$name" 2>/dev/null | head -n1)
      [ -z "$path" ] || { cp -L "$path" "$2/lib/$foreign/$name"; found=1; }
    done
  done
}
judge() {
  got() { sed -n "s/^RESULT $1 //p" results; }
  check "kernel" "$(got kernel | grep -c 'aarch64.*PREEMPT_RT')" = 1
  check "tests of the NEON kernels, exit code and number passed" "$(got kernels)" != ""
  check "exit code of the kernels' tests" "$(got kernels | cut -d' ' -f1)" = 0
  check "a frame on vcan0" "$(got can | grep -c '123 *\[4\] *11 22 33 44')" = 1
  check "an edge on gpio-sim" "$(got gpio | grep -c 'RISING EDGE')" = 1
  check "cameras of v4l2loopback" "$(got cameras)" ">=" 1
  check "gannet cameras, exit code" "$(got gannet-cameras)" = 0
  check "gannetd --check of a good file, exit code" "$(got check-good)" = 0
  check "of a broken one: exit code, place named" "$(got check-broken)" = "2 1"
}
