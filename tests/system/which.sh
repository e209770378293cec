#!/bin/bash
# The model database of P001 Fig. 5, built, listed and searched: which of twelve is in view, and
# that none is. Last line: "N passed, N failed, N skipped".
. "$(dirname "$0")/../support/cases.sh"
assets=${GANNET_ASSETS:-$PWD/build/assets}  # where they are absent all is drawn
programs gannet gannet-world

GANNET_ASSETS=none "$gannet_world" --album drawn >out.txt
check 'without photographs twelve models are drawn' test "$(ls drawn/models/*.gannet | wc -l)" -eq 12
check 'and it says so' test "$(grep -c 'a drawn picture' out.txt)" -eq 14
"$gannet_world" --album db --pairs 13 --seed 3 --assets "$assets" >out.txt
check 'a database of twelve' grep -q '^wrote 12 models and 13 pairs' out.txt
"$gannet" model list db/models >out.txt 2>err.txt
check 'model list reads all' test "$(grep -c gannet out.txt)" -eq 12
"$gannet_world" --album db --seed 3 --assets "$assets" --maps >out.txt
check 'a page of maps' grep -q '^wrote 48 maps' out.txt
check 'with a picture of each, and of each view' test "$(grep -o 'data:image/png' db/maps.html | wc -l) $(grep -o 'data:image/jpeg' db/maps.html | wc -l)" = '48 24'
check 'each is highest where the target is' test "$(awk -F, 'NR > 1 && $4 <= 5' db/maps.csv | wc -l)" -eq 48
check 'and of ours nowhere else half as high' test "$(awk -F, '$3 == "gannet" && $6 < $5 / 2' db/maps.csv | wc -l)" -eq 24
"$gannet_world" --album again --pairs 2 --seed 3 --assets "$assets" >out.txt
check 'the same seed gives the same pictures' cmp -s db/pairs/right/0001.png again/pairs/right/0001.png
"$gannet_world" --album db rov_station_keeping >out.txt 2>err.txt
check '--album runs no scenario' test $? -eq 2

which=("$gannet" which --rig db/rig.toml --models db/models)
{ head -n 3 db/pairs/truth.csv; tail -n 1 db/pairs/truth.csv; } >db/pairs/few.csv
check 'the last pair shows none' grep -q '^0012,none,' db/pairs/few.csv
"${which[@]}" --truth db/pairs/few.csv --json >out.txt 2>err.txt
check 'no wrong model is said' test $? -eq 0
check 'three pairs, each right' grep -q '"right":3,' out.txt
"${which[@]}" --left db/pairs/left/0000.png --right db/pairs/right/0000.png >out.txt
check 'one pair: the model in view' grep -q '^seahorse_left at .* 7 frames$' out.txt
"${which[@]}" --left db/pairs/left/0000.png >out.txt 2>err.txt
check 'one eye alone is refused' test $? -eq 2
mkdir empty
"$gannet" which --rig db/rig.toml --models empty --truth db/pairs/few.csv >out.txt 2>err.txt
check 'a folder without models is refused' test $? -eq 2

ending
