#!/bin/bash
# The packages, made of the programs that are built: twice from different folders the same bytes, what
# belongs in them is in them, lintian finds nothing, and the maintainer scripts enable nothing.
# Last line: "N passed, N failed, N skipped".
. "$(dirname "$0")/../support/cases.sh"
cd "$(dirname "$0")/../.." || exit 1
build=${GANNET_BUILD:-build/release}
for program in gannetd gannet gannet-world; do
  [ -x "$build/bin/$program" ] || { echo "no $build/bin/$program: run make first"; exit 77; }
done
[[ $build == *release ]] || { echo "packages are made of the release profile"; exit 77; }
command -v dpkg-shlibdeps >/dev/null || { echo "no dpkg-dev"; exit 77; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
arch=$(dpkg --print-architecture)
export SOURCE_DATE_EPOCH=1767225600 VERSION=0.1.0 COMMIT=test
export MAINTAINER='Gannet maintainers <gannet@example.org>'
unset MAKEFLAGS MAKELEVEL MFLAGS

pack() {  # OUT STAGE, with another umask and time than the last
  (umask "$3"; make --no-print-directory install -o all B="$build" DESTDIR="$2" PREFIX=/usr) >"$work/log" 2>&1 &&
    systemd/deb/build.sh "$arch" "$2" "$1" >>"$work/log" 2>&1
}
pack "$work/one" "$work/stage" 022 && pack "$work/two" "$work/other/deeper/stage" 027 ||
  { cat "$work/log"; fail "the packages are made"; ending; exit 1; }
for name in gannet gannet-world; do
  deb=${name}_0.1.0_$arch.deb
  cmp "$work/one/$deb" "$work/two/$deb" && pass || fail "$name: the same bytes again"
done
deb=$work/one/gannet_0.1.0_$arch.deb
world=$work/one/gannet-world_0.1.0_$arch.deb
dpkg-deb -c "$deb" >"$work/files"
for file in usr/bin/gannetd usr/bin/gannet usr/lib/systemd/system/gannetd.service \
  usr/lib/systemd/system/gannet-can@.service usr/lib/systemd/system/gannet.slice \
  usr/lib/systemd/system-preset/80-gannet.preset usr/lib/sysusers.d/gannet.conf usr/lib/tmpfiles.d/gannet.conf usr/lib/udev/rules.d/60-gannet.rules \
  etc/gannet/gannet.toml usr/share/man/man8/gannetd.8.gz usr/share/man/man5/gannet.toml.5.gz \
  usr/share/doc/gannet/guides/installation.md usr/share/doc/gannet/examples/rig.toml; do
  grep -q " root/root .* \./$file$" "$work/files" && pass || fail "gannet has $file"
done
grep -q gannet-world "$work/files" && fail "the world is a package of its own" || pass
dpkg-deb -c "$world" >"$work/files"
grep -q './usr/share/gannet/scenarios/rov_station_keeping.toml' "$work/files" && pass ||
  fail "gannet-world has its scenarios"
dpkg-deb -e "$deb" "$work/control"
[ "$(cat "$work/control/conffiles")" = /etc/gannet/gannet.toml ] && pass || fail "conffiles"
depends=$(dpkg-deb -f "$deb" Depends)
for library in libc6 libstdc++6 libpng16-16 libturbojpeg0 libgpiod; do
  [[ $depends == *"$library"* ]] && pass || fail "gannet depends on $library" "$depends"
done
# The scripts against stand-ins that write down how they are called. As Debian's helper does, the
# stand-in says of a unit that it does not know that it was enabled.
mkdir "$work/bin"
for command in systemd-sysusers systemd-tmpfiles udevadm systemctl deb-systemd-invoke deb-systemd-helper; do
  printf '#!/bin/sh\necho "%s $*" >>"%s/calls"\ncase $1 in debian-installed) exit ${KNOWN:-1} ;; esac\n' \
    "$command" "$work" >"$work/bin/$command"
  chmod +x "$work/bin/$command"
done
calls() { rm -f "$work/calls"; PATH=$work/bin:$PATH sh "$work/control/$1" "${@:2}" >"$work/said" 2>&1; }
calls postinst configure && ! grep -qE 'enable|start' "$work/calls" && pass ||
  fail "a first installation enables and starts nothing" "$(cat "$work/calls")"
grep -q 'systemctl enable --now gannetd' "$work/said" && pass || fail "and says what comes next"
KNOWN=0 calls postinst configure 0.0.9 && grep -q 'helper enable gannetd.service' "$work/calls" &&
  ! grep -q 'start' "$work/calls" && pass ||
  fail "an upgrade keeps what somebody has enabled, and restarts nothing" "$(cat "$work/calls")"
for script in "$work"/control/p*; do sh -n "$script" && pass || fail "${script##*/} is a shell script"; done
if command -v lintian >/dev/null; then
  lintian --fail-on error,warning,info --allow-root "$deb" "$world" >"$work/out" 2>/dev/null && pass ||
    fail "lintian finds nothing" "$(cat "$work/out")"
fi
ending
