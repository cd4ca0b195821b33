#!/usr/bin/env bash
# datasets/fetch.sh --list        prints the public datasets: name, place below DIR, size and licence
# datasets/fetch.sh NAME [DIR]    downloads one, verifies its SHA-256, unpacks it and moves it to its place below DIR
#                                 (default: $LOOPBENCH_DATA, otherwise this folder); run again, it continues a download
# Example: datasets/fetch.sh intel ~/data && ./run.sh doctor ~/data/pose_graphs/intel.g2o
# Needs curl and ca-certificates, and unzip for zip archives. LOOPBENCH_FETCH_TABLE=FILE replaces the table below.
set -euo pipefail

# Name, place, kind (file, tgz or zip), SHA-256, address, size and licence. Hashes of g2o and KITTI files are those of the
# copies that the project is tested with. TUM states none, ETH only an MD5: those of the archives are what several projects
# recorded for them.
table() {
  local tum=https://cvg.cit.tum.de/rgbd/dataset github=https://raw.githubusercontent.com
  local se_sync=$github/david-m-rosen/SE-Sync/master/data lgpl="LGPL-3.0 (SE-Sync)"
  cat <<END
tum_fr1_room tum_rgbd/rgbd_dataset_freiburg1_room tgz 5ace47a1d2e53696bc939a84999293a04a7226958e848a609666691fd3cc38da $tum/freiburg1/rgbd_dataset_freiburg1_room.tgz 0.8 GB, CC BY 4.0
tum_fr3_office tum_rgbd/rgbd_dataset_freiburg3_long_office_household tgz c7cd8e1afb87c80e5744a356214819b110fa09b4744fa4ba0cc2382f9ba59e9c $tum/freiburg3/rgbd_dataset_freiburg3_long_office_household.tgz 1.5 GB, CC BY 4.0
tum_fr1_desk tum_rgbd/rgbd_dataset_freiburg1_desk tgz e983d6830916e66dc4a46a71368046b149b283de87769690e7aa4e0b9483530c $tum/freiburg1/rgbd_dataset_freiburg1_desk.tgz 0.3 GB, CC BY 4.0
tum_fr1_xyz tum_rgbd/rgbd_dataset_freiburg1_xyz tgz a0236d97b8c30cd93b653656d2b6c293ff7c982a4130ef2a1a8beecdb124ef98 $tum/freiburg1/rgbd_dataset_freiburg1_xyz.tgz 0.4 GB, CC BY 4.0
kitti_00 kitti/00/gt_poses.txt file 90791a4113df979b149fa9e1104e960ea59f525a8318a202dbb6aec1a3d88793 $github/MichaelGrupp/evo/9ec1444a9f26a24261e1c126cd4ee2d7877cc395/test/data/KITTI_00_gt.txt 0.7 MB, CC BY-NC-SA 3.0
euroc_machine_hall euroc/machine_hall zip 5ed7d07903f8d19b6c8808e2ae8a0872b281f6e34ef5497023b8ac58c3de0f6f https://www.research-collection.ethz.ch/server/api/core/bitstreams/7b2419c1-62b5-4714-b7f8-485e5fe3e5fe/content 12.7 GB, in copyright, non-commercial use permitted
parking_garage pose_graphs/parking-garage.g2o file 3ac0a31bfb601d7455d451e2546655cb5dececf51a7823f57c8a7e0fe1ca6527 $se_sync/parking-garage.g2o 1.3 MB, $lgpl
intel pose_graphs/intel.g2o file 3e0724c048e0ba524be9dd268a8b78e19a2497043143584cbb61310638b15c4b $se_sync/intel.g2o 0.3 MB, $lgpl
mit pose_graphs/MIT.g2o file e5922be0d0689c7a5bc04c58adf3a8e697e240bdd7691cc4218470eaf92956eb $se_sync/MIT.g2o 0.1 MB, $lgpl
cubicle pose_graphs/cubicle.g2o file f7781d485383cec86d47d7650970132c36d6f3a1f4e5d62a49b7f8245c0a6465 $se_sync/cubicle.g2o 2.7 MB, $lgpl
city10000 pose_graphs/city10000.g2o file df5988994339e990be198a36e7f640e31a5a1b26df3ed400363fafc49d5ca630 $se_sync/city10000.g2o 1.8 MB, $lgpl
sphere2500 pose_graphs/sphere2500.g2o file 104ab57593394f24351d9f692f3b923f8b98fff1eb638c64356cf5049e06cf3c $se_sync/sphere2500.g2o 1.1 MB, $lgpl
torus3d pose_graphs/torus3D.g2o file 1ef8831023b372188d33ca63ce0da079d51df89364df71f2bce1c5c7c69ed5ec $se_sync/torus3D.g2o 3.3 MB, $lgpl
small_grid_3d pose_graphs/smallGrid3D.g2o file 9ea56c2ad1ebcc322560eb2f8d83cb3a60f99e2e2acc35e097b1162cdbafd649 $se_sync/smallGrid3D.g2o 0.1 MB, $lgpl
END
}
rows() { if [[ ${LOOPBENCH_FETCH_TABLE:-} ]]; then cat "$LOOPBENCH_FETCH_TABLE"; else table; fi; }
fail() { printf 'fetch.sh: %s\n' "$*" >&2; exit 1; }
hash_of() { sha256sum <"$1" | cut -d ' ' -f 1; }

[[ ${1:---help} != --help ]] || { sed -n '2,6s/^# //p' "${BASH_SOURCE[0]}"; exit; }
[[ $1 != --list ]] || { rows | awk '{ printf "%-18s %s", $1, $2; for (i = 6; i <= NF; ++i) printf " %s", $i; print "" }'; exit; }
row=$(rows | awk -v name="$1" '$1 == name')
[[ $row ]] || fail "no dataset is named '$1', expected one of:$(rows | awk '{ printf " %s", $1 }')"
read -r _ place kind hash url _ <<<"$row"
target=${2:-${LOOPBENCH_DATA:-.}}/$place part=$target.part work=$target.unpacked code=0
if [[ -e $target ]]; then
  [[ $kind != file || $(hash_of "$target") == "$hash" ]] || fail "$target: has another SHA-256; remove it to download it again"
  printf '%s: is already present\n' "$target" && exit
fi
mkdir -p "$(dirname "$target")"
curl --fail --location --show-error --proto '=http,https,file' --continue-at - --output "$part" -- "$url" || code=$?
((code != 33)) || rm -f "$part"  # the server cannot continue
[[ -e $part ]] && found=$(hash_of "$part") || found=none
# Servers call it an error to continue a part that is complete.
[[ $code == 0 || $found == "$hash" ]] || fail "$url: curl failed with exit code $code; run the command again to continue"
[[ $found == "$hash" ]] || { rm -f "$part"; fail "$url: rejected: its SHA-256 is $found, expected $hash"; }
if [[ $kind != file ]]; then
  rm -rf "$work" && mkdir "$work"
  if [[ $kind == tgz ]]; then tar -xzf "$part" -C "$work"; else unzip -q "$part" -d "$work"; fi
  content=("$work"/*)  # often one folder
  ((${#content[@]} == 1)) || content=("$work")
fi
mv "${content[0]:-$part}" "$target" && rm -rf "$work" "$part"
printf '%s: downloaded, SHA-256 verified\n' "$target"
