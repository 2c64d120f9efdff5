#include "libvdbsynth/pipeline/texture/texture_outputs.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/io/mesh_file.h"
#include "libvdbsynth/io/path.h"
#include "libvdbsynth/io/textured_mesh.h"
#include "libvdbsynth/pipeline/texture/texture_bake.h"
#include "libvdbsynth/pipeline/texture/texture_output_steps.h"

#include <algorithm>
#include <cmath>

namespace vdbsynth {

const char* const kTextureExtensions =
    ".ply, .obj, .off, .glb, .gltf, .3mf, .vdb, and with `bake` .png and .exr";

namespace {

bool isPicture(const std::string& path) {
    return extensionOf(path) == "png" || extensionOf(path) == "exr";
}

bool needsFaces(const std::string& path) {
    return extensionOf(path) != "ply" && extensionOf(path) != "vdb";
}

// Faces of sites, for their charts.
std::vector<Triangle> siteTriangles(const TextureShape& shape) {
    std::vector<Triangle> triangles = shape.triangles;
    for (Triangle& t : triangles)
        for (std::uint32_t& v : t) v = shape.siteOf[v];
    return triangles;
}

Attribute columnOf(const std::string& name, std::size_t width, std::size_t elements) {
    return {name, width, std::vector<float>(width * elements)};
}

}  // namespace

void validate(const TextureOutputOptions& options) {
    requireOption(options.bakeSize >= 16 && options.bakeSize <= 16384, "bakeSize",
                  std::to_string(options.bakeSize), "a whole number from 16 to 16384");
    requireOption(options.bakeBits == 8 || options.bakeBits == 16, "bakeBits",
                  std::to_string(options.bakeBits), "8 or 16");
    validate(options.model);
}

void requireOutputPaths(const std::vector<std::string>& paths, const TextureOutputOptions& options) {
    bool pictures = false;
    for (const std::string& path : paths) {
        MeshFormat format{};
        const bool written = extensionOf(path) == "vdb" || isPicture(path) ||
                             (writableMeshFormatOf(path, format) && format != MeshFormat::Stl);
        if (!written)
            throw Error(ErrorCode::InvalidOption,
                        path +
                            (extensionOf(path) == "stl" ? ": .stl has no colours" : ": unknown extension") +
                            "; outputs of texturing are " + kTextureExtensions);
        pictures = pictures || isPicture(path);
        if (isPicture(path) && !options.bake)
            throw Error(ErrorCode::InvalidOption,
                        path + ": pictures are baked onto the target's own texture coordinates; set `bake`");
    }
    if (options.bake && !pictures)
        throw Error(ErrorCode::InvalidOption, "`bake`: needs an output .png or .exr");
}

void requireOutputs(const TextureShape& shape, const std::vector<std::string>& paths,
                    const TextureOutputOptions& options) {
    requireOutputPaths(paths, options);
    const Attribute* uv = findAttribute(shape.attributes, "uv");
    for (const std::string& path : paths) {
        if (needsFaces(path) && shape.triangles.empty())
            throw Error(ErrorCode::Unusable,
                        path + ": needs faces, and " + shape.name +
                            " is taken as points; `as` mesh or `as` levelset gives it faces");
        if (isPicture(path) && (!uv || uv->width != 2))
            throw Error(ErrorCode::Unusable,
                        path + ": " + shape.name +
                            " has no texture coordinates to bake onto; .obj, .glb and .ply can hold them");
    }
}

Attributes textureAttributes(const TextureShape& shape, const TextureResult& result,
                             const std::vector<TextureSample>& samples) {
    const std::size_t count = shape.points.size();
    const TextureSample& sample = samples.front();
    const std::size_t channels = std::size_t(sample.image.channels);
    Attributes attributes;
    for (const SampleMap& map : sample.maps) {
        Attribute values = columnOf(map.name, std::size_t(map.channels), count);
        for (std::size_t e = 0; e < count; ++e)
            for (std::size_t c = 0; c < values.width; ++c)
                values.values[e * values.width + c] =
                    result.sites.values[shape.siteOf[e] * channels + std::size_t(map.first) + c];
        attributes.push_back(std::move(values));
    }
    Attribute u = columnOf("source_u", 1, count), v = columnOf("source_v", 1, count),
              exemplar = columnOf("source_exemplar", 1, count),
              tangent = columnOf("source_tangent", 3, count);
    for (std::size_t e = 0; e < count; ++e) {
        const std::size_t site = shape.siteOf[e];
        u.values[e] = result.sites.coordinate[site].x;
        v.values[e] = result.sites.coordinate[site].y;
        exemplar.values[e] = float(result.sites.sample[site]);
        for (int axis = 0; axis < 3; ++axis)
            tangent.values[3 * e + std::size_t(axis)] = result.sites.tangent[site][axis];
    }
    for (Attribute* column : {&u, &v, &exemplar, &tangent}) attributes.push_back(std::move(*column));
    const std::vector<char>& blended = result.sites.blended;
    if (std::find_if(blended.begin(), blended.end(), [](char b) { return b != 0; }) != blended.end()) {
        attributes.push_back(columnOf("source_blended", 1, count));
        for (std::size_t e = 0; e < count; ++e)
            attributes.back().values[e] = blended[shape.siteOf[e]] ? 1 : 0;
    }
    return attributes;
}

std::vector<Vec3f> elementNormals(const TextureShape& shape) {
    std::vector<Vec3f> ofSites = shape.normal;
    if (!shape.moved.empty() && !shape.triangles.empty()) {
        std::vector<Vec3d> sums(ofSites.size());
        for (const Triangle& t : siteTriangles(shape)) {
            const Vec3d a = cast<double>(shape.moved[t[0]]), b = cast<double>(shape.moved[t[1]]),
                        c = cast<double>(shape.moved[t[2]]);
            for (std::uint32_t v : t) sums[v] = sums[v] + cross(b - a, c - a);
        }
        for (std::size_t i = 0; i < sums.size(); ++i)
            if (length(sums[i]) > 1e-30) ofSites[i] = cast<float>(normalized(sums[i]));
    }
    std::vector<Vec3f> normals;
    normals.reserve(shape.points.size());
    for (std::uint32_t site : shape.siteOf) normals.push_back(ofSites[site]);
    return normals;
}

CornerCoordinates cornersOf(const TextureShape& shape, const TextureResult& result,
                            const std::vector<SampleImage>& images, const RunContext& ctx) {
    return cornerCoordinates({shape.site, shape.normal, result.sites, images, result.texel},
                             siteTriangles(shape), ctx);
}

void writeTextured(const TextureShape& shape, const TextureResult& result,
                   const std::vector<TextureSample>& samples, const std::vector<std::string>& paths,
                   const TextureOutputOptions& options, OutputSet& outputs, const RunContext& ctx) {
    validate(options);
    requireOutputs(shape, paths, options);
    withThreads(ctx, [&] {
        for (const std::string& path : paths) {
            Stage stage(ctx, "writing " + path, 1);
            const std::string extension = extensionOf(path);
            if (isPicture(path))
                bakeTexture(shape, result, samples, path, options.bakeSize, options.bakeBits, outputs, ctx);
            else if (extension == "vdb")
                writeTexturedVdb(shape, result, samples, outputs.add(path), options, ctx);
            else
                writeTexturedMesh(shape, result, samples, path, outputs.add(path), ctx);
            stage.advance();
        }
    });
}

}  // namespace vdbsynth
