#!/usr/bin/env bash
# Draws docs/gallery/*.svg anew, by the program alone: bash docs/gallery.sh, some minutes after `cargo build --release`.
set -euo pipefail
cd "$(dirname "$0")/.."
fretwear=${CARGO_TARGET_DIR:-target}/release/fretwear
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir -p docs/gallery

draw() { # FILE.h5 NAME [KIND]
    "$fretwear" plot "$1" -o "docs/gallery/$2.svg" --force ${3:+--kind "$3"}
}

"$fretwear" run data/scenes/paraboloid.toml -o "$work/run.h5" --quiet
for kind in profile pressure history approach loops; do draw "$work/run.h5" "$kind" "$kind"; done

"$fretwear" map -o "$work/map" --json >/dev/null
for kind in map worn-profiles optimum; do draw "$work/map/map.h5" "$kind" "$kind"; done

"$fretwear" universality data/studies/universality.toml -o "$work/universality" --quiet
draw "$work/universality/universality.h5" universality

"$fretwear" tradeoff data/tradeoff/homogeneous.toml -o "$work/tradeoff" --quiet
draw "$work/tradeoff/tradeoff.h5" tradeoff

"$fretwear" calibrate data/calibration/ball.toml -o "$work/calibration" --quiet
draw "$work/calibration/calibration.h5" calibration
"$fretwear" calibrate data/calibration/ball_amplitude.toml -o "$work/forecast" --predict data/scenes/paraboloid.toml --quiet
draw "$work/forecast/calibration.h5" calibration_forecast

cat >"$work/one.toml" <<END
title = "Limit over the amplitude"
scene = "$PWD/data/scenes/paraboloid.toml"
task = "limit"
[[axes]]
key = "loading.amplitude"
from = "0.02 um"
to = "0.6 um"
count = 30
END
cat >"$work/map.toml" <<END
title = "Limit over grading and amplitude"
scene = "$PWD/data/scenes/graded_ceramic.toml"
task = "limit"
[[axes]]
key = "half_space.grading"
from = -0.4
to = 0.8
count = 13
[[axes]]
key = "loading.amplitude_ratio"
from = 0.01
to = 0.8
count = 15
spacing = "geometric"
END
cp data/studies/friction.toml "$work/curves.toml"
cp data/studies/scatter.toml "$work/bands.toml"
sed -i "s|\.\./scenes|$PWD/data/scenes|" "$work"/{curves,bands}.toml
cp data/studies/fretting_map.toml "$work/regimes.toml"
cp data/studies/fouvry2007.toml "$work/validation.toml"
sed -i "s|\.\./scenes|$PWD/data/scenes|" "$work"/{regimes,validation}.toml
for name in one curves map bands regimes validation; do
    "$fretwear" sweep "$work/$name.toml" -o "$work/sweep_$name" --quiet
    "$fretwear" merge "$work/sweep_$name" -o "$work/sweep_$name.h5" >/dev/null
    [[ $name == regimes || $name == validation ]] || draw "$work/sweep_$name.h5" "sweep_$name"
done
draw "$work/sweep_regimes.h5" regimes regimes
draw "$work/sweep_validation.h5" validation_volume
"$fretwear" run data/scenes/fouvry2007.toml -o "$work/fouvry.h5" --quiet
draw "$work/fouvry.h5" validation_history history
