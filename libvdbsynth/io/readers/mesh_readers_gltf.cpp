// The meshes and points of glTF files.
#include "libvdbsynth/io/points/point_readers.h"
#include "libvdbsynth/io/readers/mesh_readers.h"
#include "libvdbsynth/io/readers/mesh_readers_gltf_steps.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace vdbsynth {
namespace {

// What a primitive holds, in the mesh's own space or, with a skin, in the world.
struct Primitive {
    std::uint64_t mode = kGltfTriangles;
    GltfValues places, normals;
    std::vector<double> corners;  // indices of places
    Attributes attributes;
    bool mirrored = false;
};

void keepRows(GltfValues& values, const std::vector<std::size_t>& rows) {
    if (values.count == 0) return;
    for (std::size_t i = 0; i < rows.size(); ++i)
        std::copy_n(values.numbers.begin() + std::ptrdiff_t(rows[i] * values.width), values.width,
                    values.numbers.begin() + std::ptrdiff_t(i * values.width));
    values.count = rows.size();
    values.numbers.resize(values.count * values.width);
}

// Points that indices list, once each; the others are left out.
void keepListed(Primitive& read) {
    std::vector<char> listed(read.places.count, 0);
    for (double corner : read.corners) listed[std::size_t(corner)] = 1;
    std::vector<std::size_t> rows;
    for (std::size_t i = 0; i < listed.size(); ++i)
        if (listed[i]) rows.push_back(i);
    if (rows.size() == listed.size()) return;
    keepRows(read.places, rows);
    keepRows(read.normals, rows);
    read.attributes = selectRows(read.attributes, rows);
}

// Normals keep their length and their side.
Vec3f turned(const Affine& m, const double* n) {
    const Vec3d a{m[0], m[4], m[8]}, b{m[1], m[5], m[9]}, c{m[2], m[6], m[10]}, normal{n[0], n[1], n[2]};
    const double side = determinant(m) < 0 ? -1 : 1;
    const Vec3d result{side * dot(cross(b, c), normal), side * dot(cross(c, a), normal),
                       side * dot(cross(a, b), normal)};
    const double size = length(result);
    return cast<float>(size > 0 ? result * (1 / size) : result);
}

class Reader {
public:
    Reader(const GltfFile& file, const GltfScene& scene, bool points)
        : mFile(file), mScene(scene), mPointsOnly(points) {}

    void read() {
        for (const GltfPart& part : mScene.parts()) readPart(part);
        if (mPlaceless > 0)
            mFile.say(MessageLevel::Note,
                      std::to_string(mPlaceless) + " primitives without positions left out");
        std::size_t unweighted = 0;
        for (const auto& [index, skin] : mSkins) unweighted += skin.unweighted();
        if (unweighted > 0)
            mFile.say(MessageLevel::Note, std::to_string(unweighted) +
                                              " vertices without weights follow the first joint they name");
        if (mJointless > 0)
            mFile.say(MessageLevel::Note,
                      std::to_string(mJointless) +
                          " primitives with a skin and no joints read where their node is");
        if (mTrailing > 0)
            mFile.say(MessageLevel::Note, std::to_string(mTrailing) +
                                              " corners at the end of primitives make no triangle, left out");
    }

    MeshContent mesh() {
        MeshContent content;
        content.attributes = mAttributes.finished(mPoints.size());
        content.points = std::move(mPoints);
        content.polygons = std::move(mPolygons);
        return content;
    }

    PointContent points() {
        PointContent content;
        content.attributes = mAttributes.finished(mPoints.size());
        if (mNormals.size() == mPoints.size()) content.normals = std::move(mNormals);
        content.points = std::move(mPoints);
        return content;
    }

private:
    void readPart(const GltfPart& part) {
        static const GltfJson none = GltfJson::object();
        const GltfJson& node = part.node < 0 ? none : mFile.item("nodes", part.node, "a node");
        std::vector<double> weights = mFile.numbers(node, "weights");
        if (weights.empty()) weights = mFile.numbers(mFile.item("meshes", part.mesh, "a mesh"), "weights");
        std::vector<Affine> places = gltfInstances(mFile, node);
        for (Affine& place : places) place = multiplied(part.matrix, place);
        const std::int64_t skin = mFile.index(node, "skin");
        if (skin >= 0 && gltfExtension(node, "EXT_mesh_gpu_instancing"))
            mFile.say(MessageLevel::Note, "instances of a mesh with a skin left out; it is read once");
        for (const GltfJson& primitive : gltfPrimitives(mFile, part.mesh)) {
            const std::uint64_t mode = gltfMode(mFile, primitive);
            const bool wanted = mPointsOnly ? mode == kGltfPoints : mode > kGltfLineStrip;
            Primitive read;
            if (!wanted || !decode(primitive, weights, read)) continue;
            // Joints alone say where it is.
            const bool posed = skin >= 0 && pose(primitive, skin, read);
            if (mPointsOnly) keepListed(read);
            requireRoom(read, posed ? 1 : places.size());
            if (posed)
                append(read, kIdentity);
            else
                for (const Affine& place : places) append(read, place);
        }
    }

    // @return false if it has no joints
    bool pose(const GltfJson& primitive, std::int64_t skin, Primitive& read) {
        GltfSkin& joints = mSkins.try_emplace(skin, mFile, mScene, skin).first->second;
        if (!joints.moves(primitive)) {
            ++mJointless;
            return false;
        }
        read.mirrored = joints.move(primitive, read.places);
        read.normals = {};
        return true;
    }

    // @return false if it has no positions
    bool decode(const GltfJson& primitive, const std::vector<double>& weights, Primitive& read) {
        const GltfJson* attributes = gltfMember(primitive, "attributes");
        const std::int64_t position = attributes ? mFile.index(*attributes, "POSITION") : -1,
                           normal = attributes ? mFile.index(*attributes, "NORMAL") : -1,
                           indices = mFile.index(primitive, "indices");
        requireFallback(primitive, {position, indices});
        if (position < 0) {
            ++mPlaceless;
            return false;
        }
        read.mode = gltfMode(mFile, primitive);
        read.places = gltfValues(mFile, position);
        if (read.places.width != 3) mFile.refuse("positions are not vectors of three");
        if (mPointsOnly && normal >= 0) read.normals = gltfValues(mFile, normal);
        if (read.normals.width != 3 || read.normals.count != read.places.count) read.normals = {};
        read.attributes = mAttributes.read(mFile, primitive, read.places.count);
        readCorners(indices, read);
        moveByTargets(mFile, primitive, weights, read.places);
        return true;
    }

    void readCorners(std::int64_t indices, Primitive& read) {
        const std::size_t count = read.places.count;
        if (indices >= 0) {
            GltfValues corners = gltfValues(mFile, indices);
            if (corners.width != 1) mFile.refuse("indices are not whole numbers");
            read.corners = std::move(corners.numbers);
        } else {
            for (std::size_t i = 0; i < count; ++i) read.corners.push_back(double(i));
        }
        for (double corner : read.corners)
            if (!(corner >= 0) || corner >= double(count) || corner != std::floor(corner))
                mFile.refuse("a face uses a vertex that does not exist");
    }

    // Compressed primitives may also have their data in plain accessors.
    void requireFallback(const GltfJson& primitive, const std::vector<std::int64_t>& accessors) {
        const std::string compression = gltfCompression(primitive);
        if (compression.empty()) return;
        for (std::int64_t accessor : accessors)
            if (accessor >= 0 &&
                mFile.index(mFile.item("accessors", accessor, "an accessor"), "bufferView") < 0)
                refuseGltfCompression(mFile, compression);
    }

    void requireRoom(const Primitive& read, std::size_t copies) {
        const double vertices = double(mPoints.size()) + double(copies) * double(read.places.count),
                     corners =
                         double(mPolygons.corners.size()) + 3 * double(copies) * double(read.corners.size());
        if (vertices > 4294967294.0) mFile.refuse("has over four billion vertices");
        requireMemory(mFile.context(), vertices * 48 + corners * 8, mFile.path() + ": its vertices",
                      "export a part of it");
    }

    void append(const Primitive& read, const Affine& place) {
        const std::size_t first = mPoints.size();
        for (std::size_t i = 0; i < read.places.count; ++i) {
            const double* p = &read.places.numbers[3 * i];
            mPoints.push_back(transformed(place, {p[0], p[1], p[2]}));
            if (read.normals.count > 0) mNormals.push_back(turned(place, &read.normals.numbers[3 * i]));
        }
        mAttributes.append(read.attributes, first);
        if (!mPointsOnly) appendFaces(read, first, (determinant(place) < 0) != read.mirrored);
    }

    void appendFaces(const Primitive& read, std::size_t first, bool mirrored) {
        const std::vector<double>& corners = read.corners;
        const std::size_t step = read.mode == kGltfTriangles ? 3 : 1;
        const auto corner = [&](std::size_t k) { return std::uint32_t(first) + std::uint32_t(corners[k]); };
        for (std::size_t i = 0; i + 2 < corners.size(); i += step) {
            std::uint32_t t[3] = {corner(i), corner(i + 1), corner(i + 2)};
            if (read.mode == kGltfTriangleFan) t[0] = corner(0);
            if ((read.mode == kGltfTriangleStrip && i % 2 == 1) != mirrored) std::swap(t[0], t[1]);
            if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) mPolygons.add(t, 3);
        }
        if (step == 3) mTrailing += corners.size() % 3;
    }

    const GltfFile& mFile;
    const GltfScene& mScene;
    bool mPointsOnly;
    std::vector<Vec3d> mPoints;
    std::vector<Vec3f> mNormals;
    PolygonList mPolygons;
    GltfAttributes mAttributes;
    std::map<std::int64_t, GltfSkin> mSkins;
    std::size_t mPlaceless = 0, mJointless = 0, mTrailing = 0;
};

}  // namespace

MeshContent readGltf(const std::string& path, const std::string& content, const RunContext& ctx) {
    const GltfFile file(path, content, ctx);
    const GltfScene scene(file);
    const GltfKinds kinds = gltfKinds(file, scene);
    if (kinds.triangles == 0 && kinds.points > 0) file.refuse("holds points and no triangles; it is no mesh");
    if (kinds.triangles == 0 && kinds.lines > 0)
        file.refuse("holds only lines (" + std::to_string(kinds.lines) +
                    " in number), which have no volume; export it with faces, for example lines as tubes");
    sayGltfKinds(file, kinds, /* points= */ false);
    Reader reader(file, scene, /* points= */ false);
    reader.read();
    return reader.mesh();
}

PointContent readGltfPoints(const std::string& path, const std::string& content, const RunContext& ctx) {
    const GltfFile file(path, content, ctx);
    const GltfScene scene(file);
    sayGltfKinds(file, gltfKinds(file, scene), /* points= */ true);
    Reader reader(file, scene, /* points= */ true);
    reader.read();
    return reader.points();
}

bool gltfHoldsPoints(const std::string& path, const std::string& content) {
    const RunContext silent;
    const GltfFile file(path, content, silent);
    const GltfKinds kinds = gltfKinds(file, GltfScene(file));
    return kinds.triangles == 0 && kinds.points > 0;
}

}  // namespace vdbsynth
