#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# Runs the tests of a program in up to eight processes, because a driver that meets kernels for the
# first time compiles for minutes on one core.
# usage: ./in_shares.sh PROGRAM [OPTION...]
shares=$(($(nproc) / 2))
[ $shares -gt 8 ] && shares=8
[ $shares -lt 1 ] && shares=1
folder=$(mktemp -d) || exit 1
trap 'rm -rf "$folder"' EXIT
export GTEST_TOTAL_SHARDS=$shares GTEST_SHARD_INDEX=0
processes=
while [ $GTEST_SHARD_INDEX -lt $shares ]; do
    "$@" >"$folder/$GTEST_SHARD_INDEX" 2>&1 &
    processes="$processes $!"
    GTEST_SHARD_INDEX=$((GTEST_SHARD_INDEX + 1))
done
worst=0
for process in $processes; do
    wait "$process" || worst=$?
done
cat "$folder"/*
exit $worst
