#pragma once
#include "libvdbsynth/patch/onto/onto_points.h"
#include "libvdbsynth/patch/sheet/border_moves.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace vdbsynth {

/// What the steps of ontoPoints work on.
struct OntoSource {
    const PatchExemplar& exemplar;
    const PointSetSurface& exemplarSurface;
    const PatchField& field;
    const OntoSurface& surface;
    const OntoArrangement& arrangement;
    double zero;
    const SheetOptions& options;
};

/// A patch's side of its borders.
BorderMoves ontoBorderMoves(const OntoSource& source, std::int32_t patch);

/// How many nodes every node is from one of another patch, over neighbours, up to `most`.
std::vector<std::uint8_t> ontoBorderDistance(const OntoSource& source, int most, const RunContext& ctx);

}  // namespace vdbsynth
