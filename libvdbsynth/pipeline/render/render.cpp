#include "libvdbsynth/pipeline/render/render.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/render/drawn_text.h"
#include "libvdbsynth/render/fog.h"
#include "libvdbsynth/render/picture_row.h"
#include "libvdbsynth/render/preview.h"
#include "libvdbsynth/render/slice.h"
#include "libvdbsynth/vdb/convert/level_set_to_mesh.h"

#include <algorithm>
#include <deque>
#include <memory>
#include <utility>

namespace vdbsynth {
namespace {

using Loader = std::function<ShownModel(std::size_t)>;
using Taker = std::function<void(int, const Picture&)>;

// The models of a row, laid out once for all pictures of a turntable.
struct Row {
    std::vector<std::unique_ptr<Drawing>> drawings{};
    std::deque<Mesh> meshes{};  // whose edges are drawn
    std::vector<std::pair<Vec3d, UpAxis>> views{};
};

[[noreturn]] void refuseFog(const std::string& field, const std::string& name) {
    throw Error(ErrorCode::InvalidOption,
                "`" + field + "`: " + name + " is fog, which has no surface; `iso` gives it one");
}

// What the drawing does not need of the model is dropped on return.
void addDrawing(const ShownModel& shown, const RenderOptions& options, const RunContext& ctx, Row& row) {
    PreviewOptions each;
    each.width = options.size[0];
    each.height = options.size[1];
    each.samples = options.samples;
    each.density = options.density;
    each.ground = options.ground;
    each.background = options.background;
    each.view = viewOf(shown, options);
    each.up = upOf(shown, options);
    each.directions = options.directions;
    if (!each.directions) each.colours = shownColours(shown.attributes, options.color, shown.name);
    row.views.emplace_back(each.view, each.up);
    if (shown.fog) {
        if (options.wireframe) refuseFog("wireframe", shown.name);
        if (options.directions) refuseFog("directions", shown.name);
        row.drawings.push_back(drawingOfFog(*shown.fog, each, ctx));
        return;
    }
    if (options.wireframe) {
        row.meshes.push_back(shown.model.source ? *shown.model.source
                                                : levelSetToMesh(*shown.model.grid, {}, ctx));
        each.wires = &row.meshes.back();
    }
    row.drawings.push_back(drawingOf(*shown.model.grid, each, ctx));
}

// The cameras of every model, one a picture of the turntable.
std::vector<Framing> framings(const RenderOptions& options, const Row& row) {
    const double aspect = double(options.size[0]) / options.size[1];
    const double below = options.captions.empty() ? 0 : kLabelShare;
    std::vector<Framing> all;
    const auto frame = [&](double least) {
        all.clear();
        for (std::size_t i = 0; i < row.drawings.size(); ++i) {
            const auto& [view, up] = row.views[i];
            all.push_back(framed(row.drawings[i]->outline(),
                                 turntableViews(view, up, std::max(1, options.turntable)), up, aspect, least,
                                 below));
        }
    };
    frame(0);
    double farthest = 0;
    for (const Framing& framing : all) farthest = std::max(farthest, framing.distance);
    if (options.sameScale) frame(farthest);
    return all;
}

Picture labelled(Picture picture, const RenderOptions& options, std::size_t i) {
    if (!options.captions.empty())
        labelPicture(picture, options.captions[i], /* boxed= */ options.slice.has_value());
    return picture;
}

void drawSlices(std::size_t models, const Loader& load, const RenderOptions& options, const Taker& take,
                const RunContext& ctx) {
    SliceOptions slice;
    slice.width = options.size[0];
    slice.height = options.size[1];
    slice.axis = options.slice->axis;
    slice.fraction = options.slice->fraction;
    std::vector<Picture> pictures;
    for (std::size_t i = 0; i < models; ++i) {
        const ShownModel shown = load(i);
        if (shown.fog) refuseFog("slice", shown.name);
        pictures.push_back(labelled(
            withThreads(ctx, [&] { return renderSlice(*shown.model.grid, shown.model.domain, slice, ctx); }),
            options, i));
    }
    take(1, pictureRows(pictures, std::size_t(options.columns)));
}

void drawPictures(std::size_t models, const Loader& load, const RenderOptions& options, const Taker& take,
                  const RunContext& ctx) {
    Row row;
    for (std::size_t i = 0; i < models; ++i) addDrawing(load(i), options, ctx, row);
    const std::vector<Framing> cameras = framings(options, row);
    const std::size_t count = std::size_t(std::max(1, options.turntable));
    for (std::size_t n = 0; n < count; ++n) {
        std::vector<Picture> pictures;
        for (std::size_t i = 0; i < models; ++i)
            pictures.push_back(
                labelled(withThreads(ctx, [&] { return row.drawings[i]->drawn(cameras[i].cameras[n], ctx); }),
                         options, i));
        take(int(n) + 1,
             pictures.size() == 1 ? pictures.front() : pictureRows(pictures, std::size_t(options.columns)));
    }
}

}  // namespace

void renderModels(std::size_t models, const Loader& load, const RenderOptions& options, const Taker& take,
                  const RunContext& ctx) {
    validate(options, models);
    for (const std::string& caption : options.captions)
        if (!hasLetters(caption))
            message(
                ctx, MessageLevel::Note,
                "caption " + caption + ": characters without a letter of the program's are drawn as boxes");
    if (options.slice)
        drawSlices(models, load, options, take, ctx);
    else
        drawPictures(models, load, options, take, ctx);
}

}  // namespace vdbsynth
