#!/usr/bin/env bash
# Downloads scans of the YCB object and model set and writes an object set of them.
set -euo pipefail

base_url="http://ycb-benchmarks.s3-website-us-east-1.amazonaws.com/data/google"
# The scans that config/ycb_objects.yaml lists.
default_ids=(003_cracker_box 004_sugar_box 005_tomato_soup_can 006_mustard_bottle 009_gelatin_box 010_potted_meat_can
  011_banana 012_strawberry 013_apple 014_lemon 015_peach 017_orange 024_bowl 025_mug 026_sponge 029_plate 055_baseball
  077_rubiks_cube)
# The folder in which config/ycb_objects.yaml looks for them, in the source tree or installed.
here="$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")"
case "$here" in
  */lib/early_fusion) folder="${here%/lib/early_fusion}/share/early_fusion/meshes/ycb" ;;
  *) folder="$(dirname "$here")/meshes/ycb" ;;
esac

usage() {
  cat <<EOF
Usage: $(basename "$0") [--to FOLDER] [ID...]

Downloads scans of the YCB object and model set (Calli et al. 2015, CC BY 4.0; http://www.ycbbenchmarks.com), some
megabytes each, and writes FOLDER/objects.yaml, an object set of these scans. Existing scans are not downloaded again.

  ID           a scan such as 003_cracker_box; default: the eighteen scans of config/ycb_objects.yaml
  --to FOLDER  the folder for the scans [$folder]
  --help       this text
EOF
}

fail() {
  echo "download_ycb.sh: $1" >&2
  exit 1
}

# download ID: makes FOLDER/ID/google_16k/textured.obj and its texture, or nothing.
download() {
  local id="$1" url="$base_url/$1_google_16k.tgz"
  if [[ -f "$folder/$id/google_16k/textured.obj" ]]; then
    echo "$id: already there"
    return
  fi
  echo "$id: downloading $url"
  curl --fail --location --retry 3 --silent --show-error --output "$scratch/$id.tgz" "$url" ||
    fail "cannot download $url: check the name '$id' and the network connection"
  tar -xzf "$scratch/$id.tgz" -C "$scratch" || fail "$url is not a complete archive: try again"
  [[ -f "$scratch/$id/google_16k/textured.obj" ]] ||
    fail "$url has no $id/google_16k/textured.obj: this scan cannot be used"
  rm -rf "${folder:?}/$id"
  mv "$scratch/$id" "$folder/$id"
  rm "$scratch/$id.tgz"
}

ids=()
while [[ $# -gt 0 ]]; do
  case "$1" in
    --help | -h)
      usage
      exit 0
      ;;
    --to)
      [[ $# -ge 2 ]] || fail "--to needs a folder"
      folder="$2"
      shift
      ;;
    -*) fail "unknown option '$1'; --help lists the known ones" ;;
    *)
      [[ "$1" =~ ^[0-9]{3}(-[a-z])?_[a-z0-9_-]+$ ]] || fail "'$1' is not the name of a scan such as 003_cracker_box"
      ids+=("$1")
      ;;
  esac
  shift
done
[[ ${#ids[@]} -gt 0 ]] || ids=("${default_ids[@]}")

for tool in curl tar; do
  command -v "$tool" >/dev/null || fail "needs $tool: install it first"
done
mkdir -p "$folder" || fail "cannot make the folder $folder"
# On the destination's file system, so that moving a finished scan into place is atomic.
scratch="$(mktemp -d "$folder/.download.XXXXXX")"
trap 'rm -rf "$scratch"' EXIT

for id in "${ids[@]}"; do download "$id"; done

{
  echo "# Scans of the YCB object and model set (Calli et al. 2015, CC BY 4.0), in metres. Written by download_ycb.sh."
  echo "objects:"
  for id in "${ids[@]}"; do
    # The item's name has no number: cracker_box.
    name="${id#*_}"
    echo "  - {name: $name, mesh: $id/google_16k/textured.obj, scale: 1.0}"
  done
} >"$scratch/objects.yaml"
mv "$scratch/objects.yaml" "$folder/objects.yaml"
echo "wrote $folder/objects.yaml: name it as 'objects' in the world's YAML file"
