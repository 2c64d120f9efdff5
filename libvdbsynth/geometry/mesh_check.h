#pragma once
#include "libvdbsynth/geometry/mesh.h"

#include <string>

namespace vdbsynth {

/// What every function requires of a mesh made by a program: at least one face, corners that refer to points,
/// finite points, and attributes with one row per point.
/// @param what  begins the message
/// @throw Error EmptyInput (no faces), BadData
void requireMesh(const Mesh& mesh, const std::string& what);

}  // namespace vdbsynth
