#pragma once
#include "libvdbsynth/geometry/mesh.h"

#include <string>

namespace vdbsynth {

/// What every function demands of a mesh that a program made: at least one face, corners that are among the
/// points, finite points, and attributes of one row a point.
/// @param what  begins the message
/// @throw Error EmptyInput (no faces), BadData
void requireMesh(const Mesh& mesh, const std::string& what);

}  // namespace vdbsynth
