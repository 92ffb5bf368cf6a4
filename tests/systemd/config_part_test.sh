#!/usr/bin/env bash
# An example of what goes to conf.d beside the shipped fvd.json, as fvd reads both. usage: config_part_test.sh FVD SOURCE/config PART
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cp -r "$2/fvd.json" "$2/drives" "$2/recipes" "$folder/"
mkdir "$folder/conf.d"
cp "$3" "$folder/conf.d/20-part.json"
echo "anna operate $(printf '0%.0s' {1..64})" >"$folder/tokens"
"$1" --config "$folder/fvd.json" --check-config --set paths.state_dir="$folder/state" --set paths.runtime_dir="$folder/run" || {
  echo "FAILED: it is refused"
  exit 1
}
"$1" --config "$folder/fvd.json" --dump-config >"$folder/merged" || { echo "FAILED: it cannot be printed"; exit 1; }
for word in '"port": 7413' microscope-3.example "$folder/tokens"; do
  grep -q -- "$word" "$folder/merged" || { echo "FAILED: $word is not in force"; exit 1; }
done
