# SPDX-License-Identifier: MIT
# Sourced by the scripts in this folder: the targets and their initial inputs.
osgskin_fuzz_targets="obj ply off bvh gltf glb skin weights options model pose motion bind"

# osgskin_fuzz_seeds TARGET: prints its seed files, one per line.
osgskin_fuzz_seeds() {
  local seeds=() seed
  case $1 in
    obj | ply | off | bvh) seeds=(tests/data/mesh/*."$1" tests/data/bvh/*."$1") ;;
    gltf) seeds=(tests/data/*/*.gltf tests/data/character/bad/*.gltf) ;;
    glb) seeds=(tests/data/glb/*.parts) ;;
    bind) seeds=(tests/data/bind/*.bind) ;;
    weights) seeds=(tests/data/character/weights.json) ;;
    skin) seeds=(tests/data/character/*.skin tests/data/character/bad/*.skin) ;;
  esac
  for seed in "${seeds[@]}"; do
    [ ! -f "$seed" ] || printf '%s\n' "$seed"
  done
}
