#pragma once
#include <openvdb/openvdb.h>

// The kinds of grid that functions take, for GridBase::apply.
namespace vdbsynth {

using RealScalarGrids = openvdb::TypeList<openvdb::FloatGrid, openvdb::DoubleGrid>;
using ScalarGrids = openvdb::TypeList<openvdb::FloatGrid, openvdb::DoubleGrid, openvdb::Int32Grid,
                                      openvdb::Int64Grid, openvdb::BoolGrid, openvdb::MaskGrid>;
using VectorGrids = openvdb::TypeList<openvdb::Vec3SGrid, openvdb::Vec3DGrid>;
/// Of which a mean makes sense.
using RealGrids =
    openvdb::TypeList<openvdb::FloatGrid, openvdb::DoubleGrid, openvdb::Vec3SGrid, openvdb::Vec3DGrid>;
/// That a model may carry as attributes.
using AttributeGrids =
    openvdb::TypeList<openvdb::FloatGrid, openvdb::DoubleGrid, openvdb::Int32Grid, openvdb::Int64Grid,
                      openvdb::BoolGrid, openvdb::Vec3IGrid, openvdb::Vec3SGrid, openvdb::Vec3DGrid>;
/// Whose active voxels may be a mask.
using MaskGrids =
    openvdb::TypeList<openvdb::BoolGrid, openvdb::FloatGrid, openvdb::MaskGrid, openvdb::Int32Grid>;

}  // namespace vdbsynth
