#pragma once
#include <openvdb/Platform.h>
#include <openvdb/version.h>

#include <cstdint>
#include <memory>

// Declares openvdb::FloatGrid and openvdb::GridBase without their headers, so that a header that names grids
// costs 0.1 s instead of 2 s. Written against OpenVDB 10; the alias below must name the same type as
// openvdb/openvdb.h, or a file that includes both does not compile.
namespace openvdb {
OPENVDB_USE_VERSION_NAMESPACE
namespace OPENVDB_VERSION_NAME {

class GridBase;
template <typename TreeType>
class Grid;

namespace tree {
template <typename RootNodeType>
class Tree;
template <typename ChildNodeType>
class RootNode;
template <typename ChildNodeType, std::uint32_t Log2Dim>
class InternalNode;
template <typename ValueType, std::uint32_t Log2Dim>
class LeafNode;
}  // namespace tree

using FloatTree =
    tree::Tree<tree::RootNode<tree::InternalNode<tree::InternalNode<tree::LeafNode<float, 3>, 4>, 5>>>;
using FloatGrid = Grid<FloatTree>;

}  // namespace OPENVDB_VERSION_NAME
}  // namespace openvdb

namespace vdbsynth {
using FloatGridPtr = std::shared_ptr<openvdb::FloatGrid>;
using FloatGridConstPtr = std::shared_ptr<const openvdb::FloatGrid>;
using GridPtr = std::shared_ptr<openvdb::GridBase>;
using GridConstPtr = std::shared_ptr<const openvdb::GridBase>;
}  // namespace vdbsynth
