#include "libvdbsynth/vdb/grid_kinds.h"

template class openvdb::tree::Tree<openvdb::Int32Tree::RootNodeType>;
template class openvdb::Grid<openvdb::Int32Tree>;
