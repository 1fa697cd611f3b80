#!/bin/sh
# A laptop: one worker process a core. Ctrl-C stops it, and the same command goes on.
exec lepp-study run "$@"
