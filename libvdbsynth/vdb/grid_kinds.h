#pragma once
#include <openvdb/openvdb.h>

// What files include that use OpenVDB's grids, in place of openvdb/openvdb.h.

// The code of these kinds is compiled once, in grid_kinds_KIND.cpp; without this, every file that makes such
// a grid compiles all of it again, which takes 10 s a kind (docs/decisions/030-time-to-the-first-picture.md).
// Other kinds are made in few files. What these files use of a kind in their loops is compiled and inlined
// there as before.
extern template class openvdb::tree::Tree<openvdb::FloatTree::RootNodeType>;
extern template class openvdb::Grid<openvdb::FloatTree>;
extern template class openvdb::tree::Tree<openvdb::Vec3STree::RootNodeType>;
extern template class openvdb::Grid<openvdb::Vec3STree>;
extern template class openvdb::tree::Tree<openvdb::Int32Tree::RootNodeType>;
extern template class openvdb::Grid<openvdb::Int32Tree>;

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

/// A grid without values, whose background is 0. OpenVDB's registry makes it, so that the code of its kind is
/// OpenVDB's and not compiled again: for kinds without an `extern template` above.
template <typename Grid>
typename Grid::Ptr emptyGrid() {
    openvdb::initialize();
    return openvdb::gridPtrCast<Grid>(openvdb::GridBase::createGrid(Grid::gridType()));
}

/// The same grid as what all grids have in common. Functions called on it are OpenVDB's own; called on the
/// grid of a known kind they would be compiled again.
inline openvdb::GridBase& anyKind(openvdb::GridBase& grid) {
    return grid;
}
inline const openvdb::GridBase& anyKind(const openvdb::GridBase& grid) {
    return grid;
}

}  // namespace vdbsynth
