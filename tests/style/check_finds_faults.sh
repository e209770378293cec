#!/bin/bash
# A checker that finds nothing proves nothing: check.sh is shown a small clean tree, which must
# pass, and then one fault at a time, each of which it must name.
set -u -o pipefail
check=$(cd "$(dirname "$0")" && pwd)/check.sh
tree=$(mktemp -d) || exit 2
trap 'rm -rf "$tree"' EXIT

clean() {
  rm -rf "${tree:?}"/*
  mkdir -p "$tree"/{platform/base,hal/camera,src/core,src/search,src/config,src/daemon,src/servo}
  local header='// A thing. RT safe.\n#pragma once\n'
  printf 'WARNINGS := -Wall \\\n  -Werror\n' >"$tree/Makefile"
  for thing in platform/base/ring hal/camera/eye src/core/pose src/search/genes src/daemon/messages \
    src/servo/law src/servo/servo_config; do
    printf "$header" >"$tree/$thing.hpp"
  done
  printf '#include <toml++/toml.h>\n\n#include "src/config/reader.hpp"\n#include "src/servo/servo_config.hpp"\n' >"$tree/src/config/reader.cpp"
  printf "$header" >"$tree/src/config/reader.hpp"
}

passed=0 failed=0
ok() { passed=$((passed + 1)); }
no() {
  failed=$((failed + 1))
  printf 'FAIL  %s\n' "$1"
  printf '%s\n' "$2" | sed 's/^/        /'
}
# fault NAME FILE TEXT EXPECTED: TEXT appended to FILE must make check.sh fail and say EXPECTED.
fault() {
  clean
  mkdir -p "$(dirname "$tree/$2")"
  printf "$3" >>"$tree/$2"
  local answer
  if answer=$("$check" "$tree"); then
    no "$1: was not found" "$answer"
  elif [[ $answer != *"$4"* ]]; then
    no "$1: the answer lacks \"$4\"" "$answer"
  else
    ok
  fi
}

clean
if answer=$("$check" "$tree"); then ok; else no "a clean tree passes" "$answer"; fi

fault 'search includes a camera' src/search/genes.hpp '#include "hal/camera/eye.hpp"\n' \
  'src/search/genes.hpp:3 includes hal/camera/eye.hpp, which src/search may not'
fault 'hal includes src' hal/camera/eye.hpp '#include "src/core/pose.hpp"\n' 'which hal/camera may not'
fault 'a room includes the daemon' src/servo/law.hpp '#include "src/daemon/messages.hpp"\n' \
  'which src/servo may not'
fault 'config includes code of a room' src/config/reader.hpp '#include "src/servo/law.hpp"\n' \
  'which src/config may not'
fault 'a room without a row' src/attic/box.hpp '// A box. RT safe.\n#pragma once\n' \
  'src/attic: includes'
fault 'a relative include' src/core/pose.hpp '#include "motion.hpp"\n' 'there is no motion.hpp'
fault 'a header without contract' src/core/bare.hpp '#pragma once\n' 'src/core/bare.hpp:1: no contract'
fault 'a contract without thread' src/core/mute.hpp '// Knows no thread.\n#pragma once\n' \
  'does not say who may call'
fault 'a header without guard' src/core/open.hpp '// A thing. RT safe.\n' 'no #pragma once'
fault 'a second user of toml++' src/core/again.cpp '#include <toml++/toml.h>\n' 'src/core/again'
fault 'a name in camel case' src/core/Pose2.hpp '// A thing. RT safe.\n#pragma once\n' 'src/core/Pose2.hpp'
fault 'unfinished work' src/core/pose.hpp '// TO''DO: later\n' 'no word of unfinished work'
fault 'a path of one machine' src/core/pose.hpp 'const char* p = "/ro''ot/x";\n' 'no path of one machine'
fault 'a throw' src/core/pose.cpp 'void f() { throw 1; }\n' 'nobody throws'
fault 'using namespace' src/core/pose.hpp 'using namespace gannet;\n' "no 'using namespace'"
clean
printf 'WARNINGS := -Wall\n' >"$tree/Makefile"
if "$check" "$tree" >/dev/null; then no 'warnings that are none' ''; else ok; fi
if command -v clang-format >/dev/null; then
  cp "$(dirname "$check")/../../.clang-format" "$tree/.clang-format"
  fault 'a format of its own' src/core/pose.cpp 'int   f( ) ;\n' 'src/core/pose.cpp'
fi

printf '%d passed, %d failed, 0 skipped\n' "$passed" "$failed"
[ "$failed" -eq 0 ]
