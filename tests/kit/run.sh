#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# Runs Overcast's tests and measurements on this machine, in ten minutes, and writes what they found
# to results/kit.json and results/page.md.
#
# usage: ./run.sh [--short] [DEVICE]     --short: a minute or two, to see that everything runs
#
# It needs glibc 2.36 or later and a driver with EGL; nothing is installed, and nothing is written
# outside this folder.
set -u
cd "$(dirname "$0")" || exit 1
short=0
[ "${1:-}" = --short ] && { short=1; shift; }
device=${1:-}
export OVC_KERNEL_CACHE="$PWD/results/kernels" HOME="$PWD/results"
rm -rf results && mkdir -p results/used || exit 1

# Libraries of this system are taken where there are any, because the driver uses them too; those of
# the kit where one is missing or too old.
missing() {
    ldd bin/overcast bin/gpu_test bin/plugin_test bin/gpu_probe bin/libovercast.so.1 2>&1 |
        sed -n 's/^[[:space:]]*\(lib[^ ]*\) => not found.*/\1/p
                s/^.*\/\(lib[^ /]*\): version .* not found.*/\1/p' | sort -u
}
export LD_LIBRARY_PATH="$PWD/results/used${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}"
while :; do
    added=0
    for library in $(missing); do
        if [ -e "lib/$library" ] && [ ! -e "results/used/$library" ]; then
            ln -s "$PWD/lib/$library" "results/used/$library" && added=1
        fi
    done
    [ $added = 1 ] || break
done

escaped() { # the text of a file as a string of JSON
    tr -d '\000-\010\013-\037' <"$1" | sed 's/\\/\\\\/g; s/"/\\"/g; s/	/ /g' |
        awk '{ printf "%s%s", (NR > 1 ? "\\n" : ""), $0 }'
}

failures=0
parts=
# part NAME SECONDS COMMAND...: runs the command for so many seconds at most. What it writes to
# results/NAME.json, if anything, becomes a member of the JSON.
part() {
    name=$1 limit=$2
    shift 2
    [ $short = 1 ] && limit=$((limit * 2)) # the limit guards; short parts have less to do
    began=$(date +%s)
    timeout "$limit" "$@" >"results/$name.txt" 2>&1
    code=$?
    took=$(($(date +%s) - began))
    [ $code = 0 ] || failures=$((failures + 1))
    printf '%-12s exit %d, %d s\n' "$name" $code $took
    json=null
    [ -s "results/$name.json" ] && json=$(cat "results/$name.json")
    parts="$parts${parts:+,
}  {\"name\": \"$name\", \"exit\": $code, \"seconds\": $took, \"json\": $json,
   \"text\": \"$(escaped "results/$name.txt")\"}"
    {
        printf '\n## %s\n\n`%s`: exit %d, %d s\n\n```text\n' "$name" "$*" $code $took
        tail -n 60 "results/$name.txt"
        printf '```\n'
    } >>results/parts.md
}

overcast=bin/overcast
for_device=
[ -n "$device" ] && for_device="--device $device"
if [ $short = 1 ]; then
    size=128x128 scene=sphere-5 repeats=1 seconds=3 tests='KernelGl.*' two='TwoLevelGl.EqualsBrute*'
else
    size=512x512 scene=knot repeats=3 seconds=40 two='*Gl*'
    tests='-Workarounds.StandInTheGuide' # it reads the documents
fi

part doctor 60 $overcast doctor $for_device
part devices 30 $overcast devices
part tests 90 ./in_shares.sh bin/gpu_test --gtest_filter="$tests" --gtest_brief=1
part two_level 120 ./in_shares.sh bin/plugin_test --gtest_filter="$two" --gtest_brief=1
[ $short = 1 ] || part tune 120 $overcast devices --tune $for_device
part kernels 60 $overcast bench $scene --only certified-fragment,certified-compute \
    --workloads primary,shadow,diffuse --size $size --repeats $repeats $for_device \
    --json results/kernels.json
part frames 60 $overcast bench far-terrain --only certified-compute \
    --workloads primary,shadow,diffuse --size $size --repeats $repeats $for_device \
    --json results/frames.json
part memory 90 $overcast bench $scene --only certified-compute --workloads primary,diffuse \
    --gpu-memory 64M,256M,1G,all --size $size --repeats $repeats $for_device \
    --json results/memory.json
part moving 90 $overcast bench $scene --only certified-compute --workloads primary,diffuse \
    --resident 30%,all --size $size --repeats $repeats $for_device --json results/moving.json
# A line that does not hold is a result, not a failure of the kit.
[ $short = 1 ] || part bars 150 sh -c "$overcast bench $scene --bars --scene-alone --size $size \
    --repeats $repeats $for_device --json results/bars.json || [ -s results/bars.json ]"
part picture 60 $overcast render scenes/box.ovc --size $size -o results/box.png $for_device \
    --stats results/picture.json
part probe 150 sh -c "bin/gpu_probe $seconds '$device' >results/probe.json"

system=$(uname -srm)
printf '{"kit": "%s", "system": "%s", "failures": %d, "parts": [\n%s\n]}\n' \
    "$(cat VERSION)" "$system" $failures "$parts" >results/kit.json
{
    printf '# Overcast %s on %s\n\n%d of its parts failed.\n' "$(cat VERSION)" "$system" $failures
    cat results/parts.md
} >results/page.md
rm -rf results/used results/parts.md
echo "results/kit.json and results/page.md tell all; please send them"
[ $failures = 0 ]
