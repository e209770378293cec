#!/bin/bash
# The committed manual pages and references are what the programs say of themselves today, and
# groff, where there is one, reads the pages without a complaint.
set -u
build=${GANNET_BUILD:-build/release}
for program in gannet gannetd gannet-world; do
  [ -x "$build/bin/$program" ] || { echo "no $build/bin/$program: run make first"; exit 77; }
done
fresh=$(mktemp -d)
trap 'rm -rf "$fresh"' EXIT
tests/support/make_docs.sh "$build" "$fresh" || exit 1
failed=0
pages=0
for file in "$fresh"/man/* "$fresh"/reference/*; do
  committed=docs/${file#"$fresh"/}
  pages=$((pages + 1))
  if ! diff -u "$committed" "$file" >"$fresh/diff" 2>&1; then
    echo "$committed is not current; run make docs"
    head -20 "$fresh/diff"
    failed=$((failed + 1))
  fi
done
if command -v groff >/dev/null; then
  for page in "$fresh"/man/*; do
    complaint=$(groff -K utf8 -man -Tutf8 -ww -z "$page" 2>&1) || true
    [ -z "$complaint" ] || { echo "$page: $complaint"; failed=$((failed + 1)); }
  done
fi
echo "$((pages - failed)) passed, $failed failed, 0 skipped"
[ $failed -eq 0 ]
