#!/bin/bash
# build.sh ARCH STAGE OUT [ADMINDIR LIBDIR …]: makes the packages gannet and gannet-world out of what
# `make install` has put below STAGE, with PREFIX=/usr. ADMINDIR and LIBDIRs: dpkg's database and
# the libraries of a foreign architecture. SOURCE_DATE_EPOCH dates everything, so that the same sources
# give the same bytes. Environment: VERSION, COMMIT, MAINTAINER.
set -eu -o pipefail
umask 022
export LC_ALL=C.UTF-8 TZ=UTC
arch=$1 stage=$(realpath "$2") out=$3 admindir=${4:-}
shift $(($# < 4 ? $# : 4))
libdirs=("$@")
here=$(dirname "$0")
: "${SOURCE_DATE_EPOCH:?}" "${VERSION:?}" "${COMMIT:?}" "${MAINTAINER:?}"
export SOURCE_DATE_EPOCH
date=$(date -R -d "@$SOURCE_DATE_EPOCH")
work=$stage.packages
rm -rf "$work"
mkdir -p "$work/gannet" "$work/gannet-world" "$work/debian" "$out"

# ---- who gets what
cp -a "$stage/." "$work/gannet"
move() {  # PATH …: from gannet to gannet-world
  local path
  for path; do
    [ -e "$work/gannet/$path" ] || continue
    mkdir -p "$work/gannet-world/$(dirname "$path")"
    mv "$work/gannet/$path" "$work/gannet-world/$path"
  done
}
mapfile -t pages < <(cd "$work/gannet" && compgen -G 'usr/share/man/man1/gannet-world*.1')
move usr/bin/gannet-world "${pages[@]}" usr/share/gannet/scenarios usr/share/gannet/assets
units=$(cd "$work/gannet/usr/lib/systemd/system" && echo *.service)

fill() {
  sed -e "s|@VERSION@|$VERSION|; s|@ARCH@|$arch|; s|@COMMIT@|$COMMIT|; s|@DATE@|$date|" \
    -e "s|@MAINTAINER@|$MAINTAINER|; s|@UNITS@|$units|" -e "s|@SIZE@|${size:-}|; s|@SHLIBS@|${shlibs:-}|" "$1"
}

# ---- a package
package() {  # NAME
  local name=$1 root=$work/$1 doc=$work/$1/usr/share/doc/$1
  mkdir -p "$doc" "$root/DEBIAN"
  cp "$here/copyright" "$doc/copyright"
  [ "$name" = gannet ] || cat "$here/copyright.photographs" >>"$doc/copyright"
  fill "$here/changelog" | gzip -9n >"$doc/changelog.gz"
  find "$root/usr/share/man" -name '*.[1-8]' -exec gzip -9n {} +
  if [ -e "$here/$name.overrides" ]; then
    mkdir -p "$root/usr/share/lintian/overrides"
    cp "$here/$name.overrides" "$root/usr/share/lintian/overrides/$name"
  fi
  local programs
  mapfile -t programs < <(find "$root/usr/bin" -type f | sort)
  # It insists on a debian/control to look at.
  printf 'Source: gannet\n\nPackage: %s\nArchitecture: any\n' "$name" >"$work/debian/control"
  shlibs=$(cd "$work" && dpkg-shlibdeps -O --ignore-missing-info ${admindir:+--admindir="$admindir"} \
    "${libdirs[@]/#/-l}" "${programs[@]/#/-e}" 2>"$work/shlibdeps.log") ||
    { cat "$work/shlibdeps.log" >&2; exit 1; }
  shlibs=${shlibs#shlibs:Depends=}
  [ -n "$shlibs" ] || { echo "deb: no library of $name belongs to a package" >&2; exit 1; }
  size=$(du -k --apparent-size -s "$root" | cut -f1)
  fill "$here/control.$name" >"$root/DEBIAN/control"
  if [ "$name" = gannet ]; then
    local script
    for script in postinst prerm postrm; do
      fill "$here/$script" >"$root/DEBIAN/$script"
      chmod 755 "$root/DEBIAN/$script"
    done
    (cd "$root" && find etc -type f | sort | sed 's|^|/|') >"$root/DEBIAN/conffiles"
  fi
  (cd "$root" && find . -type f ! -path './DEBIAN/*' ! -path './etc/*' -printf '%P\0' | sort -z |
    xargs -0 md5sum) >"$root/DEBIAN/md5sums"
  local deb=$out/${name}_${VERSION}_$arch.deb
  dpkg-deb --root-owner-group -Zxz --build "$root" "$deb" >/dev/null
  printf '%s\n  installed size %s KiB, package %s KiB\n  depends on %s\n' "$deb" "$size" \
    "$(($(stat -c %s "$deb") / 1024))" "$(dpkg-deb -f "$deb" Depends)"
}
package gannet
package gannet-world
