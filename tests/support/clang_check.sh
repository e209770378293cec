#!/bin/sh
# clang_check.sh FLAG … FILE …: checks each file with clang++; flags begin with "-" or follow one.
set -u
flags= files= 
for word; do
  case $word in
    *.cpp) files="$files $word" ;;
    *) flags="$flags $word" ;;
  esac
done
for file in $files; do
  extra=
  case $file in
    *_avx2.cpp) extra=-mavx2 ;;
    *_avx512.cpp) extra="-mavx512f -mavx512bw -mavx512vl -mavx512vnni" ;;
  esac
  # shellcheck disable=SC2086
  clang++-14 $flags $extra "$file" || exit 255
done
