#!/bin/bash
# sysroot.sh ARCH DIR PACKAGE …: unpacks these -dev packages and all that they need, of another
# architecture, below DIR, for cross-compiling. The machine's own dpkg and apt are not touched: lists,
# cache and database are private. DIR/dpkg becomes a database that dpkg-shlibdeps can ask.
set -eu -o pipefail
export LC_ALL=C
arch=$1 dir=$(realpath -m "$2")
shift 2
stamp=$dir/complete
[ "$(cat "$stamp" 2>/dev/null)" = "$*" ] && exit 0
rm -rf "$dir"
mkdir -p "$dir"/apt/{lists/partial,cache/archives/partial,log} "$dir/dpkg/info" "$dir/tree"
: >"$dir/apt/status"
apt=(apt-get -qq -o "APT::Architecture=$arch" -o "APT::Architectures=$arch" -o APT::Sandbox::User=root
     -o "Dir::State=$dir/apt" -o "Dir::State::lists=$dir/apt/lists" -o "Dir::State::status=$dir/apt/status"
     -o "Dir::Cache=$dir/apt/cache" -o "Dir::Log=$dir/apt/log" -o Debug::NoLocking=1
     -o APT::Install-Recommends=false)
echo "  APT  $arch: $*"
"${apt[@]}" update >"$dir/apt/log/update" 2>&1 || { cat "$dir/apt/log/update" >&2; exit 1; }
"${apt[@]}" -y --download-only install "$@" >"$dir/apt/log/install" 2>&1 ||
  { cat "$dir/apt/log/install" >&2; exit 1; }
for deb in "$dir"/apt/cache/archives/*.deb; do
  name=$(dpkg-deb -f "$deb" Package)
  case $name in
    # The cross compiler brings headers of its own.
    libc6-dev | libc-dev-bin | linux-libc-dev | libcrypt-dev | libstdc++-*-dev | libgcc-*-dev) continue ;;
  esac
  dpkg-deb -x "$deb" "$dir/tree"
  # What dpkg would have written, with the paths where the files really are.
  info=$dir/dpkg/info/$name
  dpkg-deb --fsys-tarfile "$deb" | tar -t | sed -e 's|/$||' -e "s|^\.|$dir/tree|" >"$info.list"
  mkdir "$dir/control"
  dpkg-deb -e "$deb" "$dir/control"
  for file in symbols shlibs; do
    [ ! -e "$dir/control/$file" ] || cp "$dir/control/$file" "$info.$file"
  done
  { sed -n '/^Package:/p; /^Version:/p; /^Architecture:/p; /^Multi-Arch:/p; /^Maintainer:/p; /^Description:/p' "$dir/control/control"
    printf 'Status: install ok installed\n\n'; } >>"$dir/dpkg/status"
  rm -r "$dir/control"
done
echo "$arch" >"$dir/dpkg/arch"
echo "$*" >"$stamp"
