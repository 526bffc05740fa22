#!/usr/bin/env bash
# Hands sweep-hq.sh in to a running HyperQueue server, written by `fretwear submit`. Options go to hq submit:
#     bash submit.sh --array=3,17       only these shards
# Prints the number of the job; `bash merge-hq.sh NUMBER` then waits for it and merges.
set -euo pipefail
cd -- @FOLDER@
mkdir -p log
case " $* " in
*" --array"*) ;;
*) set -- --array=0-@LAST@ "$@" ;;
esac
# Two files of output per task are spared: each shard writes its own log.
hq --output-mode=quiet submit --name=@NAME@ --cpus=@CPUS@ --crash-limit=@REQUEUES@ --stdout=none --stderr=none@MORE@ "$@" -- \
    bash ./sweep-hq.sh
