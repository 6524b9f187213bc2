#!/usr/bin/env bash
# Downloads scans of the YCB object and model set and writes an object set of them.
set -euo pipefail

base_url="https://ycb-benchmarks.s3.amazonaws.com/data/google"
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
Usage: $(basename "$0") [--to FOLDER] [--checksums FILE] [ID...]

Downloads scans of the YCB object and model set (Calli et al. 2015, CC BY 4.0; http://www.ycbbenchmarks.com), some
megabytes each, and writes FOLDER/objects.yaml, an object set of these scans. Existing scans are not downloaded again.

  ID           a scan such as 003_cracker_box; default: the eighteen scans of config/ycb_objects.yaml
  --to FOLDER  the folder for the scans [$folder]
  --checksums FILE
               lines of sha256sum, such as FOLDER/SHA256SUMS of an earlier download: archives with another checksum, or
               without one, are refused
  --help       this text
EOF
}

fail() {
  echo "download_ycb.sh: $1" >&2
  exit 1
}

# check ARCHIVE: compares its checksum with the given ones, and notes it.
check() {
  local sum line
  sum="$(cd "$scratch" && sha256sum "$1")"
  if [[ -n "$checksums" ]]; then
    line="$(grep -E "^[0-9a-f]{64} [ *]$1\$" "$checksums" | head -n 1)" || fail "$checksums has no checksum of $1"
    [[ "${line:0:64}" == "${sum:0:64}" ]] ||
      fail "$1 has the SHA-256 ${sum:0:64}, not ${line:0:64} as in $checksums: it was changed or damaged"
  fi
  echo "$sum" >>"$scratch/SHA256SUMS"
}

# unpack ARCHIVE ID: only the three expected files, as the caller's own plain files.
unpack() {
  local files=("$2/google_16k/textured.obj" "$2/google_16k/textured.mtl" "$2/google_16k/texture_map.png")
  tar -xzf "$scratch/$1" -C "$scratch" --no-same-owner --no-same-permissions "${files[@]}" ||
    fail "$1 is not a complete archive of ${files[*]}: try again"
  [[ -z "$(find "$scratch/$2" ! -type f ! -type d)" ]] || fail "$1 has links or devices in place of files"
  find "$scratch/$2" -type d -exec chmod 755 {} + -o -type f -exec chmod 644 {} +
}

# download ID: makes FOLDER/ID/google_16k/textured.obj and its texture, or nothing.
download() {
  local id="$1" url="$base_url/$1_google_16k.tgz"
  if [[ -f "$folder/$id/google_16k/textured.obj" ]]; then
    echo "$id: already there"
    return
  fi
  echo "$id: downloading $url"
  curl --fail --location --proto =https --retry 3 --silent --show-error --output "$scratch/$id.tgz" "$url" ||
    fail "cannot download $url: check the name '$id' and the network connection"
  check "$id.tgz"
  unpack "$id.tgz" "$id"
  rm -rf "${folder:?}/$id"
  mv "$scratch/$id" "$folder/$id"
  rm "$scratch/$id.tgz"
}

ids=()
checksums=""
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
    --checksums)
      [[ $# -ge 2 && -r "$2" ]] || fail "--checksums needs a file that can be read"
      checksums="$(readlink -f "$2")"
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

for tool in curl sha256sum tar; do
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
    # The item's name has no number: cracker_box; the letter of one of several parts comes last: cups_a.
    name="${id#*_}"
    [[ "$id" =~ ^[0-9]{3}-([a-z])_ ]] && name+="_${BASH_REMATCH[1]}"
    echo "  - {name: $name, mesh: $id/google_16k/textured.obj, scale: 1.0}"
  done
} >"$scratch/objects.yaml"
mv "$scratch/objects.yaml" "$folder/objects.yaml"
if [[ -f "$scratch/SHA256SUMS" ]]; then
  touch "$folder/SHA256SUMS"
  sort -u -k 2 -o "$folder/SHA256SUMS" "$folder/SHA256SUMS" "$scratch/SHA256SUMS"
fi
echo "wrote $folder/objects.yaml: name it as 'objects' in the world's YAML file"
