#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/io/output_set.h"
#include "libvdbsynth/pipeline/texture/texture.h"
#include "libvdbsynth/vdb/vdb_file.h"

#include <string>
#include <vector>

namespace vdbsynth {

struct TextureOutputOptions {
    ModelOptions model;    ///< voxels of a level set made from a mesh
    VdbMetadata metadata;  ///< of .vdb outputs
    /// Pictures (.png, .exr) are baked onto the target's own texture coordinates (texture_bake.h).
    bool bake = false;
    int bakeSize = 1024;  ///< [pixels] side of a picture, 16..16384
    int bakeBits = 8;     ///< of .png: 8 or 16
};

/// @throw Error InvalidOption (a field out of its range)
void validate(const TextureOutputOptions& options);

/// The extensions that writeTextured writes, in words.
extern const char* const kTextureExtensions;

/// What the target must be for its outputs, before the work begins: faces for .obj, .off, .glb, .gltf and
/// .3mf; faces with texture coordinates for pictures.
/// @throw Error InvalidOption (an unknown extension, pictures without `bake`, `bake` without pictures),
/// Unusable (the target has no faces, or no texture coordinates)
void requireOutputs(const TextureShape& shape, const std::vector<std::string>& paths,
                    const TextureOutputOptions& options);
/// The part that needs no target. @throw Error InvalidOption
void requireOutputPaths(const std::vector<std::string>& paths, const TextureOutputOptions& options);

/// What a textured target has at every element: `Cd` and the other maps by name, then where they come from:
/// `source_u` and `source_v` [texels], `source_exemplar` (-1: none), `source_tangent` (3, the direction of
/// +u) and, where any is a mix of several places, `source_blended` (1 there).
Attributes textureAttributes(const TextureShape& shape, const TextureResult& result,
                             const std::vector<TextureSample>& samples);
/// Unit normals of the elements as outputs have them, recomputed from the faces where they were displaced.
std::vector<Vec3f> elementNormals(const TextureShape& shape);

/// Writes a textured target to every path, its kind by extension:
/// - .ply: points or mesh with normals, colours, and all of textureAttributes; the samples' sizes are in
///   comments, for textureRepeat (texture_repeat.h);
/// - .obj: mesh with colours, texture coordinates and normals; .off: mesh with colours;
/// - .glb, .gltf: mesh with texture coordinates of corners and the samples' pictures; maps named roughness,
///   metallic and normal become those of the material;
/// - .vdb: of points OpenVDB points; of others a level set `surface` with `Cd`, the other maps, source_u,
///   source_v and source_exemplar in its band, read through the coordinates of the nearest site, extended;
/// - .png, .exr: see texture_bake.h.
/// Nothing is renamed into place; `outputs.commit()` does that.
/// @throw Error as requireOutputs; Io, Memory
/// @par Repeats byte for byte
void writeTextured(const TextureShape& shape, const TextureResult& result,
                   const std::vector<TextureSample>& samples, const std::vector<std::string>& paths,
                   const TextureOutputOptions& options, OutputSet& outputs, const RunContext& ctx = {});

}  // namespace vdbsynth
