# The guest as files and processes: what must be there before a scenario, and one run of it.
# Sourced by run.

uuid=11111111-2222-3333-4444-555555555555  # not random: a repeat must give the same bits

boot() {  # ROOT.ext4 on|off (changes stay) DISK.ext4 SEED CONSOLE LIMIT_S
  local time=(-accel "tcg,thread=single" -icount "shift=0,sleep=off" -cpu max) serial=(-serial "file:$5")
  [ -z "${KVM:-}" ] || time=(-accel kvm -cpu host)
  [ -z "$shell" ] || serial=(-serial stdio)
  timeout --foreground "$6" $(cat "$cache/qemu.command") "${time[@]}" -seed "$4" -rtc base=2035-01-01,clock=vm \
    -machine pc,nvdimm=on -smp 1 -m 768M,slots=4,maxmem=4G -nodefaults -no-user-config \
    -display none -no-reboot -kernel "$cache/vmlinux" -initrd "$cache/initrd" "${serial[@]}" \
    -append "console=ttyS0 root=/dev/pmem0 quiet panic=-1 mitigations=off net.ifnames=0 \
tsc=reliable nokaslr systemd.show_status=0 ${APPEND:-}" \
    -object "memory-backend-file,id=m0,share=$2,mem-path=$1,size=700M" \
    -device nvdimm,id=nv0,memdev=m0,unarmed=off \
    -object "memory-backend-file,id=m1,share=on,mem-path=$3,size=96M" -device nvdimm,id=nv1,memdev=m1
}

disk() {  # FOLDER IMAGE
  rm -f "$2"
  mke2fs -q -F -t ext4 -O '^metadata_csum,^64bit,^has_journal' -m 0 -U $uuid -E "hash_seed=$uuid" \
    -d "$1" "$2" 96M >/dev/null
}

prepare() {
  "$here/guest/build.sh" "$cache"
  local tool
  for tool in poke hold; do
    [ "$cache/$tool" -nt "$here/guest/$tool.c" ] ||
      gcc -O2 -Wall -Wextra -Werror -static -o "$cache/$tool" "$here/guest/$tool.c"
  done
}

install_package() {
  local debs stamp work=$cache/install
  debs=$(ls build/deb/gannet*_amd64.deb 2>/dev/null || true)
  [ -n "$debs" ] || { echo "hil: no package in build/deb: make deb" >&2; exit 1; }
  # shellcheck disable=SC2086
  stamp=$(cat "$cache/stamp" $debs "$here/guest/install" | sha256sum | cut -c1-16)
  [ "$(cat "$cache/ready.stamp" 2>/dev/null)" != "$stamp" ] || return 0
  echo "  HIL   installing the package"
  rm -rf "$work" "$cache/ready.stamp"
  mkdir -p "$work/out"
  # shellcheck disable=SC2086
  cp $debs "$here/guest/lib.sh" "$work"
  cp "$here/guest/install" "$work/start"
  disk "$work" "$cache/install.ext4"
  rm -r "$work"
  mkdir "$work"
  cp --sparse=always "$cache/base.ext4" "$cache/ready.ext4"
  keep= shell= boot "$cache/ready.ext4" on "$cache/install.ext4" 1 "$cache/install.console" 1200
  debugfs -R "rdump /out $work" "$cache/install.ext4" 2>/dev/null
  [ "$(cat "$work/out/rc" 2>/dev/null)" = 0 ] || { cat "$work/out/log" "$cache/install.console" >&2; exit 1; }
  rm "$cache/install.ext4"
  echo "$stamp" >"$cache/ready.stamp"
}

run_scenario() {  # NAME SEED RESULTS
  local name=$1 seed=$2 results=$3 files
  rm -rf "$results"
  mkdir -p "$results"
  if [ "$(. "$here/scenarios/$name.sh"; echo "${OWN_MACHINE:-}")" = 1 ]; then
    (. "$here/scenarios/$name.sh"; machine "$seed" "$results")
    return
  fi
  (flock 9; install_package) 9>"$cache/lock"
  files=$results/files
  mkdir -p "$files/out"
  cp "$here"/guest/start "$here"/guest/lib.sh "$cache"/{poke,hold} "$files"
  cp "$here/scenarios/$name.sh" "$files/scenario.sh"
  (
    . "$here/scenarios/$name.sh"
    sed -e "s|@CHECKS@|${CHECKS:-}|; s|@DURATION@|${DURATION:-9}|; s|@DRIVES@|${DRIVES:-dronecan_esc}|" "$here/world.toml"
    printf '%s\n' "${EVENTS:-}" | sed -n 's/^ *\([0-9.]*\) s: \(.*\)/[[event]]\nat_s = \1\ndo = "\2"/p'
  ) >"$files/scenario.toml"
  { echo "SEED=$seed"; echo "SHELL_WANTED=$shell"; } >>"$files/lib.sh"
  find "$files" -exec touch -h -d '2035-01-01 UTC' {} +
  disk "$files" "$results/disk.ext4"
  rm -r "$files"
  [ -e "$cache/ready.stamp" ] || return 1
  boot "$cache/ready.ext4" off "$results/disk.ext4" "$seed" "$results/console" \
    "$([ -n "$shell" ] && echo 0 || echo "${HOST_LIMIT_S:-1200}")" || return 1
  debugfs -R "rdump /out $results" "$results/disk.ext4" 2>/dev/null
  mv "$results"/out/* "$results"
  rmdir "$results/out"
  [ -n "$keep" ] || rm "$results/disk.ext4"
  [ -e "$results/rc" ]
}
