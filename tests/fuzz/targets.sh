# SPDX-License-Identifier: MIT
# Sourced by the scripts beside it: the targets, and what each starts from.
osgskin_fuzz_targets="obj ply off bvh gltf glb skin weights options model pose bind"

# osgskin_fuzz_seeds TARGET: its seed files, a line each.
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
