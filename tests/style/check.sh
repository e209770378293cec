#!/bin/bash
# The rules of the house that a machine can check: who includes whom, what each header says of its
# threads, where foreign headers may appear, names and words. No tools but bash, grep, sed, awk;
# clang-format where there is one. Prints what is wrong and, as its last line,
# "N passed, N failed, N skipped"; exit 1 if anything failed.
#
#   tests/style/check.sh          all checks
#   tests/style/check.sh DIR      the same on another tree (the test of this script uses it)
set -u -o pipefail
export LC_ALL=C.UTF-8
cd "${1:-$(dirname "$0")/../..}" || exit 2

passed=0 failed=0 skipped=0
# report NAME [LINES]: passed if there are no lines, else failed, showing them.
report() {
  if [ -z "${2:-}" ]; then
    passed=$((passed + 1))
  else
    failed=$((failed + 1))
    printf 'FAIL  %s\n' "$1"
    printf '%s\n' "$2" | sed 's/^/        /'
  fi
}
skip() {
  skipped=$((skipped + 1))
  printf 'SKIP  %s\n' "$1"
}

# ---- which files ---------------------------------------------------------------------------------
# Those that git knows or would know; in an unpacked archive all but what was built.
all_files() {
  if git rev-parse --show-toplevel >/dev/null 2>&1 && [ -e .git ]; then
    git ls-files -co --exclude-standard
  else
    find . -path ./build -prune -o -type f -print | sed 's|^\./||'
  fi | while IFS= read -r file; do [ -f "$file" ] && printf '%s\n' "$file"; done
}
files=$(all_files | sort)
code=$(printf '%s\n' "$files" | grep -E '^(platform|hal|src|tests)/.*\.(cpp|hpp)$')
house=$(printf '%s\n' "$code" | grep -vE '^tests/')
of() { printf '%s\n' "$house" | grep -E "^$1/"; }  # a room's files

# ---- layers --------------------------------------------------------------------------------------
# room | prefixes of what its files may include besides the room itself. A prefix that ends in a
# file's name allows just that file. Where a row is wider than the picture in docs/map.md the
# reason stands behind it. CONFIG: the rooms' config structs, *_config.hpp; IMAGES: the cameras'
# image types, no device.
layers='
platform/base  |
platform/linux | platform/base/
hal/camera     | platform/
hal/can        | platform/
hal/gpio       | platform/
hal/drive      | platform/ hal/can/can_frame.hpp
src/core       | platform/base/
src/search     | platform/base/ src/core/
src/vision     | platform/base/ src/core/ hal/camera/image_view.hpp
src/track      | platform/base/ src/core/ src/search/ src/vision/ hal/camera/image_view.hpp # takes pairs
src/servo      | platform/base/ src/core/
src/vehicle    | platform/base/ src/core/ hal/drive/drive_values.hpp
src/safety     | platform/base/ src/core/
src/config     | platform/ src/core/ CONFIG
src/telemetry  | platform/ src/core/
src/control    | platform/ src/core/
src/image_file | platform/ src/core/ IMAGES # decodes into pictures of camera formats
src/report     | platform/ src/core/ src/image_file/
src/modeldb    | platform/ src/core/ src/vision/ src/image_file/ src/config/ IMAGES # header is TOML
src/world      | platform/ hal/ src/
src/tool       | platform/ hal/ src/
src/console    | platform/ src/core/ src/control/ src/telemetry/ src/image_file/ src/report/
src/daemon     | platform/ hal/ src/
'
# Nobody includes a program, except itself.
programs='src/(world|tool|console|daemon)/'

row_of() { printf '%s\n' "$layers" | sed 's/#.*//' | awk -F'|' -v room="$1" '{name = $1; gsub(/ /, "", name)} name == room {print "x" $2}'; }

may_include() {  # may_include ROOM INCLUDED ALLOWED…
  local room=$1 included=$2 allowed
  shift 2
  [[ $included == "$room"/* ]] && return 0
  [[ $included =~ ^$programs ]] && return 1
  for allowed in "$@"; do
    [[ $allowed == CONFIG && $included =~ ^(hal|src)/.*_config\.hpp$ ]] && return 0
    [[ $allowed == IMAGES && $included =~ ^hal/camera/(image|image_view|pixel_access)\.hpp$ ]] && return 0
    [[ $included == "$allowed" || ($allowed == */ && $included == "$allowed"*) ]] && return 0
  done
  return 1
}

includes_of() { grep -nE '^[[:space:]]*#[[:space:]]*include[[:space:]]*"' "$@" /dev/null | sed -E 's/^([^:]+:[0-9]+):[^"]*"([^"]*)".*/\1 \2/'; }

rooms=$(printf '%s\n' "$house" | sed -nE 's,^((platform|hal|src)/[^/]+)/.*,\1,p' | sort -u)
for room in $rooms; do
  row=$(row_of "$room")
  if [ -z "$row" ]; then
    report "$room: includes" "the room has no row in the table of $0"
    continue
  fi
  set -f; allowed=(${row#x}); set +f
  bad=$(includes_of $(of "$room") | while read -r where included; do
    if ! may_include "$room" "$included" ${allowed[@]+"${allowed[@]}"}; then
      printf '%s includes %s, which %s may not\n' "$where" "$included" "$room"
    fi
  done)
  report "$room: includes" "$bad"
done

report "quoted includes name a file from the root" "$(includes_of $code | while read -r where included; do
  [ -f "$included" ] || printf '%s: there is no %s\n' "$where" "$included"
done)"

# ---- public headers ------------------------------------------------------------------------------
# The comment that a header starts with: up to the first line that is not a comment.
contract() { awk '!/^\/\//{exit} {print}' "$1"; }
for room in $rooms; do
  bad=$(of "$room" | grep '\.hpp$' | while IFS= read -r header; do
    words=$(contract "$header" | tr '\n' ' ' | sed 's|// *||g; s/no threads\?//g')
    if [ -z "$words" ]; then
      printf '%s:1: no contract: say what it is, its units, its errors, and who may call\n' "$header"
    elif ! [[ $words =~ (RT[- ]safe|[Ss]tart-up\ only|[Aa]ny\ thread|[a-z]\ threads?|thread\'s) ]]; then
      printf '%s:1: the contract does not say who may call: RT safe, start-up only, <name> thread or any thread\n' "$header"
    fi
    grep -q '^#pragma once$' "$header" || printf '%s:1: no #pragma once\n' "$header"
  done)
  report "$room: contracts" "$bad"
done

# ---- foreign headers, each behind one file pair --------------------------------------------------
one_pair() {  # one_pair NAME REGEX; x_v1.cpp and x_v2.cpp are one, of which a build takes one
  local users
  users=$(grep -lE "^[[:space:]]*#[[:space:]]*include[[:space:]]*<($2)" $house /dev/null | sed -E 's/(_v[0-9])?\.(cpp|hpp)$//' | sort -u)
  if [ "$(printf '%s' "$users" | grep -c .)" -gt 1 ]; then
    report "$1 behind one file pair" "$users"
  else
    report "$1 behind one file pair"
  fi
}
one_pair 'toml++' 'toml\+\+/|toml\.hpp'
one_pair 'V4L2' 'linux/videodev2\.h|linux/v4l2'
one_pair 'SocketCAN' 'linux/can\.h|linux/can/|linux/if_arp\.h'
one_pair 'libgpiod' 'gpiod\.'
one_pair 'libpng' 'png\.h'
one_pair 'libjpeg-turbo' 'turbojpeg\.h|jpeglib\.h'

# ---- names and words -----------------------------------------------------------------------------
report "code files and their folders are snake_case" "$(printf '%s\n' "$files" |
  grep -E '^(platform|hal|src|tests)/' | grep -E '\.(cpp|hpp|sh)$' |
  grep -vE '^([a-z0-9_]+/)+[a-z0-9_]+(\.[a-z0-9_]+)*$')"

texts=$(printf '%s\n' "$files" | grep -E '(\.(cpp|hpp|sh|toml|md|in|service|mk|yaml|yml)|Makefile|README|\.ci/run)$')
# Written apart, so that this file does not find itself.
unfinished='TO''DO|FIX''ME|XX''X|HA''CK'
report "no word of unfinished work" "$(grep -nwE "$unfinished" $texts /dev/null; grep -niw 'place''holders\?' $texts /dev/null)"
report "no path of one machine" "$(grep -nE '(^|[^[:alnum:]_.*$}-])/(wo''rk|ro''ot|ho''me|tm''p)(/|[^[:alnum:]_-]|$)' $texts /dev/null)"

# ---- no exceptions of ours, no globals that register themselves ----------------------------------
report "nobody throws" "$(grep -nE '^[^/"#]*\bthrow\b' $house /dev/null)"
report "no 'using namespace' in a header" "$(printf '%s\n' "$house" | grep '\.hpp$' | xargs -r grep -nE '^[[:space:]]*using namespace' /dev/null)"

report "warnings are errors" "$(grep -qE '^WARNINGS *:=' Makefile && sed -n '/^WARNINGS/,/[^\\]$/p' Makefile | grep -q -- '-Werror' || echo 'Makefile: WARNINGS has no -Werror')"

# ---- format --------------------------------------------------------------------------------------
if command -v clang-format >/dev/null; then
  report "clang-format finds nothing to change (make format)" "$(printf '%s\n' "$code" | grep . |
    xargs -r -n 40 clang-format --dry-run 2>&1 | grep -E '^[^ ].*: (warning|error):' | sed 's/: warning: .*/: not as clang-format has it/' | cut -d: -f1,4- | sort | uniq -c | sed 's/^ *//')"
else
  skip "clang-format is not installed"
fi

printf '%d passed, %d failed, %d skipped\n' "$passed" "$failed" "$skipped"
[ "$failed" -eq 0 ]
