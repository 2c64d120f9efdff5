// Textured points and meshes as files.
#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/io/mesh_file.h"
#include "libvdbsynth/io/path.h"
#include "libvdbsynth/io/png_file.h"
#include "libvdbsynth/io/textured_mesh.h"
#include "libvdbsynth/pipeline/texture/texture_output_steps.h"
#include "libvdbsynth/pipeline/texture/texture_repeat.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace vdbsynth {
namespace {

std::uint8_t byteOf(float value) {
    return std::uint8_t(std::lround(double(std::clamp(value, 0.f, 1.f)) * 255));
}

// A picture of 8 bits, rows from the top. @param colour  writes three values of a texel
std::string pictureOf(const SampleImage& image, const std::function<void(const float*, float*)>& colour) {
    Picture picture{image.width, image.height, {}};
    picture.pixels.reserve(3 * image.texels());
    float rgb[3] = {};
    for (int y = image.height - 1; y >= 0; --y)
        for (int x = 0; x < image.width; ++x) {
            colour(image.texel(x, y), rgb);
            for (float value : rgb) picture.pixels.push_back(byteOf(value));
        }
    return encodePng(picture);
}

const SampleMap* mapNamed(const TextureSample& sample, const std::string& name) {
    for (const SampleMap& map : sample.maps)
        if (map.name == name) return &map;
    return nullptr;
}

MeshPictures picturesOf(const TextureSample& sample) {
    MeshPictures pictures;
    pictures.name = sample.name;
    pictures.repeats = sample.image.tileable;
    pictures.colour =
        pictureOf(sample.image, [](const float* from, float* rgb) { std::copy(from, from + 3, rgb); });
    const SampleMap *rough = mapNamed(sample, "roughness"), *metal = mapNamed(sample, "metallic"),
                    *normal = mapNamed(sample, "normal");
    if (rough || metal)
        pictures.roughness = pictureOf(sample.image, [&](const float* from, float* rgb) {
            rgb[0] = 0;
            rgb[1] = rough ? from[rough->first] : 1;
            rgb[2] = metal ? from[metal->first] : 0;
        });
    if (normal && normal->channels == 3)
        pictures.normal = pictureOf(sample.image, [&](const float* from, float* rgb) {
            std::copy(from + normal->first, from + normal->first + 3, rgb);
        });
    return pictures;
}

// The file's own attributes, but those that texturing replaces.
Attributes withOwnAttributes(const TextureShape& shape, Attributes attributes) {
    for (const Attribute& own : shape.attributes)
        if (own.name != "Alpha" && own.name != "N" && !findAttribute(attributes, own.name))
            attributes.push_back(own);
    return attributes;
}

Mesh meshOf(const TextureShape& shape, Attributes attributes) {
    Mesh mesh;
    mesh.points = shape.points;
    mesh.origin = shape.origin;
    mesh.triangles = shape.triangles;
    mesh.attributes = std::move(attributes);
    return mesh;
}

TexturedMesh texturedMeshOf(const TextureShape& shape, const TextureResult& result,
                            const std::vector<TextureSample>& samples, Attributes attributes,
                            const std::string& path, const RunContext& ctx) {
    const std::vector<SampleImage> images = imagesOf(samples);
    CornerCoordinates corners = cornersOf(shape, result, images, ctx);
    if (corners.torn > 0)
        message(ctx, MessageLevel::Detail,
                path + ": " + std::to_string(corners.torn) + " of " + std::to_string(shape.triangles.size()) +
                    " triangles lie across charts; each takes that of one corner");
    TexturedMesh textured;
    textured.mesh = meshOf(shape, std::move(attributes));
    textured.normals = elementNormals(shape);
    textured.comments = sampleComments(result, samples);
    textured.corner = std::move(corners.coordinate);
    for (std::size_t t = 0; t < shape.triangles.size(); ++t) {
        const std::size_t s = std::size_t(std::max(0, corners.sample[t]));
        textured.pictures.push_back(std::uint32_t(s));
        for (std::size_t k = 0; k < 3; ++k) {
            Vec2f& at = textured.corner[3 * t + k];
            at = {at.x / float(images[s].width), at.y / float(images[s].height)};
        }
    }
    return textured;
}

void notePictures(const TextureShape& shape, const std::vector<TextureSample>& samples,
                  const std::string& path, const RunContext& ctx) {
    if (findAttribute(shape.attributes, "uv"))
        message(ctx, MessageLevel::Note,
                path + ": the texture coordinates of " + shape.name + " are replaced by those of the sample");
    if (extensionOf(path) == "obj") return;
    for (const TextureSample& sample : samples)
        for (const SampleMap& map : sample.maps) {
            const bool embedded = map.name == "Cd" || map.name == "roughness" || map.name == "metallic" ||
                                  (map.name == "normal" && map.channels == 3);
            if (embedded && map.white == 255) continue;
            message(ctx, MessageLevel::Note,
                    path + ": the map " + map.name + " of " + sample.name +
                        (embedded ? " is embedded as a picture of 8 bits"
                                  : " is written as values of vertices, as glTF's materials have no such "
                                    "picture"));
        }
}

void writePictured(const TextureShape& shape, const TextureResult& result,
                   const std::vector<TextureSample>& samples, const std::string& path,
                   const std::string& temporary, const RunContext& ctx) {
    notePictures(shape, samples, path, ctx);
    TexturedMesh textured =
        texturedMeshOf(shape, result, samples,
                       withOwnAttributes(shape, textureAttributes(shape, result, samples)), path, ctx);
    if (extensionOf(path) == "obj") {
        for (const TextureSample& sample : samples)
            textured.materials.push_back({sample.name, "", "", "", false});
        message(ctx, MessageLevel::Note,
                path + ": holds colours and texture coordinates, not the picture; .glb embeds it");
        return writeTexturedObj(temporary, textured);
    }
    for (const TextureSample& sample : samples) textured.materials.push_back(picturesOf(sample));
    writeTexturedGltf(temporary, extensionOf(path) == "glb", textured);
}

}  // namespace

void writeTexturedMesh(const TextureShape& shape, const TextureResult& result,
                       const std::vector<TextureSample>& samples, const std::string& path,
                       const std::string& temporary, const RunContext& ctx) {
    const std::string extension = extensionOf(path);
    if (extension == "obj" || extension == "glb" || extension == "gltf")
        return writePictured(shape, result, samples, path, temporary, ctx);
    Attributes attributes = withOwnAttributes(shape, textureAttributes(shape, result, samples));
    if (extension == "off" || extension == "3mf") {
        if (samples.front().maps.size() > 1)
            message(ctx, MessageLevel::Note,
                    path + ": ." + extension + " holds the colour only, no other map");
        return writeMesh(temporary, extension == "off" ? MeshFormat::Off : MeshFormat::ThreeMf,
                         meshOf(shape, std::move(attributes)));
    }
    const std::vector<std::string> comments = sampleComments(result, samples);
    if (!shape.triangles.empty())
        return writePly(temporary, meshOf(shape, std::move(attributes)), elementNormals(shape), comments);
    PointCloud cloud;
    cloud.points = shape.points;
    cloud.origin = shape.origin;
    cloud.normals = elementNormals(shape);
    cloud.attributes = std::move(attributes);
    writePly(temporary, cloud, comments);
}

}  // namespace vdbsynth
