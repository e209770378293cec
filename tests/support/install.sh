#!/bin/sh
# install.sh PACKAGE …: installs with apt what is missing of these Debian packages; says nothing and
# does nothing when all are there. Needs root or sudo only if something is missing.
set -eu
missing=
for package; do
  dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null | grep -qx installed || missing="$missing $package"
done
[ -n "$missing" ] || exit 0
command -v apt-get >/dev/null || { echo "install: this machine has no apt-get; install by hand:$missing" >&2; exit 1; }
as_root=
if [ "$(id -u)" != 0 ]; then
  command -v sudo >/dev/null || { echo "install: neither root nor sudo; ask for:$missing" >&2; exit 1; }
  as_root=sudo
fi
echo "  APT $missing"
log=$(mktemp)
{ $as_root apt-get -o DPkg::Lock::Timeout=600 -qq update &&
  # shellcheck disable=SC2086
  $as_root env DEBIAN_FRONTEND=noninteractive apt-get -o DPkg::Lock::Timeout=600 -qq -y \
    --no-install-recommends install $missing; } >"$log" 2>&1 || { cat "$log" >&2; exit 1; }
rm -f "$log"
