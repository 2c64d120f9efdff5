#pragma once
#include "libvdbsynth/patch/sheet/sheet_points.h"
#include "libvdbsynth/points/point_set_surface.h"
#include "tests/support/patch_shapes.h"

#include <utility>

// Small arrangements of patches.
namespace vdbsynth::test {

// An exemplar with all that is made of it.
struct Texture {
    PatchExemplar exemplar;
    PatchField field;
    PointSetSurface surface;

    Texture(PatchExemplar made, double step)
        : exemplar(std::move(made)),
          field(measuredField(exemplar, step)),
          surface(exemplar.points, exemplar.normals) {}

    SheetResult sheet(const PatchArrangement& arrangement, const SheetOptions& options,
                      const RunContext& ctx = {}) const {
        return sheetPoints(exemplar, surface, field, arrangement, options, ctx);
    }
};

// Patch 0 over the left half, patch 1 over the right.
inline PatchArrangement halves(const Texture& texture, int nx, int ny, const LaidPatch& left,
                               const LaidPatch& right) {
    PatchArrangement sheet;
    sheet.lattice = {texture.field.lattice.step, nx, ny, texture.field.lattice.nz};
    sheet.patches = {left, right};
    for (int i = 0; i < nx; ++i)
        sheet.label.insert(sheet.label.end(), std::size_t(ny) * std::size_t(sheet.lattice.nz),
                           i < nx / 2 ? 0 : 1);
    return sheet;
}

// The exemplar's left 20 columns, as two patches that continue each other but for `fine`.
inline PatchArrangement cutInTwo(const Texture& texture, const Vec3d& fine) {
    return halves(texture, 20, 24, {{0, 0}, {0, 0}, 14, 24, {}, 0}, {{6, 0}, {6, 0}, 14, 24, fine, 0});
}

}  // namespace vdbsynth::test
