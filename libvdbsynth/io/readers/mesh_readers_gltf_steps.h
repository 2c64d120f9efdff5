#pragma once
// What the parts of the glTF reader share, behind readGltf (mesh_readers.h) and readGltfPoints.
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/geometry/attribute.h"
#include "libvdbsynth/math/affine.h"

#include <nlohmann/json.hpp>

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace vdbsynth {

using GltfJson = nlohmann::json;

/// A parsed file of version 2. Its buffers are read when they are first used. What is wrong with it is an
/// Error BadData that names the file.
class GltfFile {
public:
    /// All are borrowed. @throw Error BadData (not glTF, another version, a required extension not read)
    GltfFile(const std::string& path, const std::string& content, const RunContext& ctx);

    [[noreturn]] void refuse(const std::string& what) const;
    void say(MessageLevel level, const std::string& what) const;
    const std::string& path() const { return mPath; }
    const RunContext& context() const { return mContext; }

    /// The index that the file names, 0 if it names none.
    std::int64_t defaultScene() const;
    /// An array of the file, empty if there is none.
    const GltfJson& list(const char* name) const;
    /// @param what  for the error, for example "a buffer view"
    const GltfJson& item(const char* list, std::int64_t index, const char* what) const;
    /// -1 if there is none.
    std::int64_t index(const GltfJson& object, const char* name) const;
    std::vector<std::int64_t> indices(const GltfJson& object, const char* name) const;
    std::uint64_t whole(const GltfJson& object, const char* name, std::uint64_t missing = 0) const;
    /// Numbers of an array; empty if there is none. @param size  that it must have, 0 for any
    std::vector<double> numbers(const GltfJson& object, const char* name, std::size_t size = 0) const;

    /// Bytes of a buffer.
    std::string_view buffer(std::int64_t index) const;
    /// Bytes of the file and of all buffers read so far: more elements than these are no real data.
    std::size_t bytes() const;

private:
    std::string bufferBytes(std::int64_t index) const;

    const std::string& mPath;
    const std::string& mContent;
    const RunContext& mContext;
    GltfJson mJson;
    std::string_view mBinary;  // the second chunk of a .glb
    mutable std::map<std::int64_t, std::string> mBuffers;
};

/// The JSON and the binary chunk of a .gltf or .glb file.
struct GltfChunks {
    std::string_view json, binary;
    std::uint64_t missing = 0;  ///< bytes that its chunks claim and the file lacks
};
/// @throw Error BadData
GltfChunks gltfChunks(const std::string& path, const std::string& content);

/// A member of an object, or null.
const GltfJson* gltfMember(const GltfJson& object, const char* name);
const GltfJson* gltfExtension(const GltfJson& object, const char* name);
/// Text of a file for a message: printable ASCII, cut to a length.
std::string gltfShown(const std::string& text);

/// @throw Error BadData that names a required extension that is not read
void checkGltfExtensions(const GltfFile& file, const GltfJson& root);
/// A compression that a buffer view or primitive has as an extension, empty if none.
std::string gltfCompression(const GltfJson& object);
[[noreturn]] void refuseGltfCompression(const GltfFile& file, const std::string& extension);

/// Values of an accessor, normalised integers as real numbers.
struct GltfValues {
    std::size_t count = 0, width = 0;  ///< elements, numbers of each
    std::vector<double> numbers;       ///< [count x width]
};
GltfValues gltfValues(const GltfFile& file, std::int64_t accessor);

/// A mesh at its place.
struct GltfPart {
    std::int64_t node = -1, mesh = -1;  ///< node is -1 if the file has no nodes
    Affine matrix = kIdentity;
};

/// The nodes of the default scene. What other nodes hold is a note.
class GltfScene {
public:
    explicit GltfScene(const GltfFile& file);
    const std::vector<GltfPart>& parts() const { return mParts; }
    /// The transform of a node of the scene, or of none.
    Affine globalOf(std::int64_t node) const;

private:
    void visit(const std::vector<std::int64_t>& roots);
    void sayWhatIsLeftOut() const;

    const GltfFile& mFile;
    std::vector<GltfPart> mParts;
    std::vector<char> mReached;
    std::size_t mHidden = 0;
    mutable std::vector<char> mKnown;
    mutable std::vector<Affine> mGlobal;
    mutable std::vector<std::int64_t> mParents;
};

/// glTF's numbers for kinds of primitives.
enum GltfMode : std::uint64_t {
    kGltfPoints = 0,
    kGltfLineStrip = 3,
    kGltfTriangles = 4,
    kGltfTriangleStrip = 5,
    kGltfTriangleFan = 6
};
std::uint64_t gltfMode(const GltfFile& file, const GltfJson& primitive);
/// An array.
const GltfJson& gltfPrimitives(const GltfFile& file, std::int64_t mesh);

/// How many primitives of each kind a scene has.
struct GltfKinds {
    std::size_t triangles = 0, lines = 0, points = 0;
};
GltfKinds gltfKinds(const GltfFile& file, const GltfScene& scene);
/// Notes about those that are left out, and about animations. @param points  true if points are read
void sayGltfKinds(const GltfFile& file, const GltfKinds& kinds, bool points);

/// Transforms of the copies of a node's mesh (EXT_mesh_gpu_instancing); one that changes nothing without it.
std::vector<Affine> gltfInstances(const GltfFile& file, const GltfJson& node);

/// Moves vertices by the morph targets of a primitive.
void moveByTargets(const GltfFile& file, const GltfJson& primitive, const std::vector<double>& weights,
                   GltfValues& places);

/// Joints in their default pose.
class GltfSkin {
public:
    GltfSkin(const GltfFile& file, const GltfScene& scene, std::int64_t skin);
    /// True if a primitive names joints.
    bool moves(const GltfJson& primitive) const;
    /// Moves vertices of such a primitive into the world. @return true if most are mirrored
    bool move(const GltfJson& primitive, GltfValues& places);
    std::size_t unweighted() const { return mUnweighted; }

private:
    Affine blended(const std::vector<GltfValues>& joints, const std::vector<GltfValues>& weights,
                   std::size_t vertex);

    const GltfFile& mFile;
    std::vector<Affine> mJoints;
    std::size_t mUnweighted = 0;
};

/// Attributes of the vertices of a file's primitives: COLOR_0 is Cd (and Alpha), TEXCOORD_0 uv with v upwards
/// as other formats have it, _NAME is NAME.
class GltfAttributes {
public:
    /// Values of one primitive, for `count` vertices.
    Attributes read(const GltfFile& file, const GltfJson& primitive, std::size_t count) const;
    /// Appends them for the vertices from `first` on.
    void append(const Attributes& values, std::size_t first);
    /// All of them; vertices without a value have 1 as a colour, else 0.
    Attributes finished(std::size_t count);

private:
    std::map<std::string, Attribute> mAttributes;
};

}  // namespace vdbsynth
