#!/bin/bash
# `gannet locate`, `track` and `map` on a pair that shows the model's own photo: found where it was
# photographed, the same to the last digit for every number of threads and every kernel, and not
# found where there is nothing. Last line: "N passed, N failed, N skipped".
. "$(dirname "$0")/../support/cases.sh"
programs gannet

small_rig >rig.toml
build_disc >out.txt || exit 1
check 'build tells points and size' grep -Eq 'disc: [0-9]+ points on the target, .* 14[0-9]\.[0-9] x 14[0-9]\.[0-9] mm' out.txt
check 'build writes a preview' test -s disc-preview.png

locate=("$gannet" locate --rig rig.toml --left "$pictures/target.png" --right "$pictures/target.png"
        --model disc.gannet --evaluations 3000 --json)
without_time() { sed 's/"time_ms":[^,]*,//'; }
"${locate[@]}" --threads 1 --simd scalar >out.txt
check 'it is found' test $? -eq 0
without_time <out.txt >first.txt
check 'where it was photographed' awk -F'[][,]' '{ exit !($3 > -0.006 && $3 < 0.006 && $4 > -0.006 && $4 < 0.006 && $5 > 0.36 && $5 < 0.44) }' out.txt
for threads in 1 2 3 7 200; do
  for simd in scalar auto; do
    "${locate[@]}" --threads $threads --simd $simd | without_time >out.txt
    check "the same with $threads threads and $simd kernels" cmp -s first.txt out.txt
  done
done
"${locate[@]}" --overlay seen.png >out.txt
check 'the overlay is written' test -s seen.png

echo 'of an earlier search' >none.png
"$gannet" locate --rig rig.toml --left "$pictures/empty.png" --right "$pictures/empty.png" \
  --model disc.gannet --evaluations 3000 --json --overlay none.png >out.txt
check 'nothing is found in an empty scene' test $? -eq 1
check 'its pose is null' grep -q '^{"found":false,"position_m":null,"quaternion":null,"sigma_m":null,"sigma_rad":null,' out.txt
check 'no overlay without a pose' test ! -e none.png

mkdir -p frames/left frames/right
for i in 1 2 3; do
  cp "$pictures/target.png" frames/left/$i.png
  cp "$pictures/target.png" frames/right/$i.png
done
cp "$pictures/empty.png" frames/left/4.png
cp "$pictures/empty.png" frames/right/4.png
"$gannet" track --rig rig.toml --model disc.gannet frames --fps 10 --evaluations 3000 >out.txt 2>/dev/null
check 'track has a header and a row for each frame' test "$(wc -l <out.txt)" -eq 5
check 'track has the columns of the contract' grep -qx 'frame,time_s,state,found,x_m,y_m,z_m,qw,qx,qy,qz,sigma_x_m,sigma_y_m,sigma_z_m,sigma_rx,sigma_ry,sigma_rz,fitness,evaluations,time_ms,model' out.txt
check 'track locks on' grep -Eq '^3,0\.200000,locked,1,' out.txt
check 'pose fields are empty where nothing was found' grep -Eq '^4,0\.300000,[a-z]+,0,,,,,,,,,,,,,,' out.txt
check 'each row has all columns' awk -F, 'NF != 21 { exit 1 }' out.txt
"$gannet" track --rig rig.toml --model disc.gannet frames --fps 10 --evaluations 3000 --filter --csv rows.csv >out.txt 2>/dev/null
check 'rows go into a file' test "$(wc -l <rows.csv)" -eq 5
check 'and not to standard output' test ! -s out.txt

"$gannet" map --rig rig.toml --left "$pictures/target.png" --right "$pictures/target.png" \
  --model disc.gannet --z-mm 400 --step-mm 10 -o map.png >out.txt 2>/dev/null
check 'the map is written' test -s map.png
check 'its best place is the target' awk -F, 'NR > 1 && (best == "" || $3 > best) { best = $3; x = $1; y = $2 }
  END { exit !(x > -0.011 && x < 0.011 && y > -0.011 && y < 0.011) }' map.csv

mkdir -p models && cp disc.gannet models && echo 'no model' >models/torn.gannet
"$gannet" model list models >out.txt 2>err.txt
check 'model list passes over what is no model' test $? -eq 1
check 'and names it' grep -q 'torn.gannet' err.txt
check 'and lists the others' grep -Eq '^disc +14[0-9]\.[0-9] +14[0-9]\.[0-9] +models/disc.gannet' out.txt
"$gannet" model list nowhere >out.txt 2>err.txt
check 'model list refuses a folder that is not there' test $? -eq 2
"$gannet" model show disc.gannet --rig rig.toml --json >out.txt
check 'model show has six sigmas' grep -Eq '"least_sigma":\[([0-9.e-]+,){5}[0-9.e-]+\]' out.txt
"$gannet" model show models/torn.gannet >out.txt 2>err.txt
check 'model show refuses what is no model' test $? -eq 2

for group in 'model build' 'config show'; do
  "$gannet" ${group% *} --help >out.txt 2>&1
  check "gannet ${group% *} --help ends well" test $? -eq 0
  check "gannet ${group% *} --help lists ${group#* }" grep -q "${group#* }" out.txt
done

ending
