#!/bin/sh
# One big server: server.sh mine.toml results/mine. It goes on when you log out, and writes run.log.
set -eu
lepp-study compile
nohup lepp-study run "$2" --config "$1" --workers "$(nproc)" >run.log 2>&1 &
echo "kill $! stops it; the same command goes on from there"
