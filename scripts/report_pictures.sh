#!/usr/bin/env bash
# report_pictures.sh [GEOMETRY]: makes the pictures of docs/reading_the_report.md anew. GEOMETRY is the folder of real CAD files,
# ../shared/geometry by default. Needs the release build and chromium.
set -euo pipefail
cd "$(dirname "$0")/.."
geometry=$(realpath "${1:-../shared/geometry}")
runs=out/report_pictures
mkdir -p $runs
ln -sfn "$geometry" $runs/geometry
program=$PWD/build/release/bin/aeroloom

scripts/mpirun_local.sh 2 "$program" run configs/acceptance/whole_dlr_f6.yaml --set output.directory=$runs/good \
  --set "geometry.file=$runs/geometry/aircraft/gmsh_dlr_f6.brep" --set improve.gate.smallest_angle=20
scripts/mpirun_local.sh 2 "$program" run configs/transport.yaml --set output.directory=$runs/missed \
  --set sizing.minimum=0.12 --set sizing.surface_maximum=1.2 --set sizing.curvature_angle=12 --set sizing.growth=1.35 \
  --set improve.gate.min_mean_ratio=0.5 || test $? -eq 6

python3 scripts/report_pictures.py $runs/good/report.html $runs/good/at \
  screen::620 screen:pictures::0.5 screen:histograms screen:stages
python3 scripts/report_pictures.py $runs/missed/report.html $runs/missed/at screen::900
cp $runs/good/at_screen.png docs/pictures/report_head.png
cp $runs/good/at_screen_pictures.png docs/pictures/report_pictures.png
cp $runs/good/at_screen_histograms.png docs/pictures/report_histograms.png
cp $runs/good/at_screen_stages.png docs/pictures/report_stages.png
cp $runs/missed/at_screen.png docs/pictures/report_failed.png
ls -l docs/pictures/report_*.png
