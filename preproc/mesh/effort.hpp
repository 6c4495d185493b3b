// How much time the stages spend for better meshes.
#pragma once

namespace scan2fea {

// `low` for previews and sweeps of parameters, `high` for fidelity and the last degrees of angles.
enum class Effort { low, normal, high };

}  // namespace scan2fea
