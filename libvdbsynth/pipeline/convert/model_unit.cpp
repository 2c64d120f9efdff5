#include "libvdbsynth/pipeline/convert/model_unit.h"

#include "libvdbsynth/vdb/grid_kinds.h"

#include <algorithm>

namespace vdbsynth {

std::string unitOf(const openvdb::GridBase& grid) {
    constexpr std::size_t kLongest = 12;
    const auto meta = grid.getMetadata<openvdb::StringMetadata>(kUnitKey);
    const std::string unit = meta ? meta->value() : "";
    const bool letters = std::all_of(unit.begin(), unit.end(),
                                     [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); });
    return letters && unit.size() <= kLongest ? unit : "";
}

std::string unitOf(const LevelSet& model) {
    return unitOf(*model.grid);
}

void setUnit(openvdb::GridBase& grid, const std::string& unit) {
    grid.removeMeta(kUnitKey);
    if (!unit.empty()) grid.insertMeta(kUnitKey, openvdb::StringMetadata(unit));
}

LevelSet inUnit(const LevelSet& model, const std::string& unit) {
    if (unit.empty() || !unitOf(model).empty()) return model;
    LevelSet named = model;
    named.grid = model.grid->copy();
    setUnit(*named.grid, unit);
    return named;
}

}  // namespace vdbsynth
