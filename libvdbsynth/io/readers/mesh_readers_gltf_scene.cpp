// Nodes of glTF: which meshes the default scene has, and where.
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/io/readers/mesh_readers_gltf_steps.h"

#include <algorithm>
#include <cmath>

namespace vdbsynth {
namespace {

// Scale, then rotation by a quaternion of any length, then translation; each may be missing.
Affine composed(const double* translation, const double* turn, const double* scale) {
    Affine m = kIdentity;
    const double size =
        turn ? std::sqrt(turn[0] * turn[0] + turn[1] * turn[1] + turn[2] * turn[2] + turn[3] * turn[3]) : 0;
    if (size > 0) m = rotation(turn[0] / size, turn[1] / size, turn[2] / size, turn[3] / size);
    for (std::size_t c = 0; scale && c < 3; ++c)
        for (std::size_t r = 0; r < 3; ++r) m[c * 4 + r] *= scale[c];
    for (std::size_t r = 0; translation && r < 3; ++r) m[12 + r] = translation[r];
    return m;
}

Affine matrixOf(const GltfFile& file, const GltfJson& node) {
    const std::vector<double> matrix = file.numbers(node, "matrix", 16);
    Affine m = kIdentity;
    if (!matrix.empty()) {
        std::copy(matrix.begin(), matrix.end(), m.begin());
        return m;
    }
    const std::vector<double> translation = file.numbers(node, "translation", 3),
                              turn = file.numbers(node, "rotation", 4),
                              scale = file.numbers(node, "scale", 3);
    const auto data = [](const std::vector<double>& v) { return v.empty() ? nullptr : v.data(); };
    return composed(data(translation), data(turn), data(scale));
}

bool isHidden(const GltfJson& node) {
    const GltfJson* visibility = gltfExtension(node, "KHR_node_visibility");
    const GltfJson* visible = visibility ? gltfMember(*visibility, "visible") : nullptr;
    return visible && *visible == false;
}

// Nodes below some roots; those already marked are not visited again.
void mark(const GltfFile& file, std::vector<std::int64_t> open, std::vector<char>& marked) {
    while (!open.empty()) {
        const std::int64_t node = open.back();
        open.pop_back();
        if (std::size_t(node) >= marked.size() || marked[std::size_t(node)]) continue;
        marked[std::size_t(node)] = 1;
        for (std::int64_t child : file.indices(file.item("nodes", node, "a node"), "children"))
            open.push_back(child);
    }
}

}  // namespace

GltfScene::GltfScene(const GltfFile& file) : mFile(file) {
    const GltfJson &nodes = file.list("nodes"), &scenes = file.list("scenes"), &meshes = file.list("meshes");
    mReached.assign(nodes.size(), 0);
    mKnown.assign(nodes.size(), 0);
    mGlobal.resize(nodes.size());
    mParents.assign(nodes.size(), -1);
    for (std::size_t i = 0; i < nodes.size(); ++i)
        for (std::int64_t child : file.indices(file.item("nodes", std::int64_t(i), "a node"), "children"))
            if (std::size_t(child) < mParents.size()) mParents[std::size_t(child)] = std::int64_t(i);
    if (!scenes.empty()) {
        visit(file.indices(file.item("scenes", file.defaultScene(), "its scene"), "nodes"));
    } else {
        std::vector<std::int64_t> roots;
        for (std::size_t i = 0; i < nodes.size(); ++i)
            if (mParents[i] < 0) roots.push_back(std::int64_t(i));
        visit(roots);
    }
    if (nodes.empty() && !meshes.empty()) {
        for (std::size_t i = 0; i < meshes.size(); ++i) mParts.push_back({-1, std::int64_t(i), kIdentity});
        file.say(MessageLevel::Note, "has no nodes; its meshes are read as they are");
    }
    sayWhatIsLeftOut();
}

void GltfScene::visit(const std::vector<std::int64_t>& roots) {
    struct Visit {
        std::int64_t node;
        Affine matrix;
        bool hidden;
    };
    std::vector<Visit> open;
    for (auto root = roots.rbegin(); root != roots.rend(); ++root) open.push_back({*root, kIdentity, false});
    while (!open.empty()) {
        const Visit visit = open.back();
        open.pop_back();
        const GltfJson& node = mFile.item("nodes", visit.node, "a node");
        const std::size_t place = std::size_t(visit.node);
        if (mReached[place]) mFile.refuse("its nodes are not a tree");
        const Affine matrix = multiplied(visit.matrix, matrixOf(mFile, node));
        const bool hidden = visit.hidden || isHidden(node);
        mReached[place] = mKnown[place] = 1;
        mGlobal[place] = matrix;
        const std::int64_t mesh = mFile.index(node, "mesh");
        if (mesh >= 0 && !hidden) mParts.push_back({visit.node, mesh, matrix});
        if (mesh >= 0 && hidden) ++mHidden;
        const std::vector<std::int64_t> children = mFile.indices(node, "children");
        for (auto child = children.rbegin(); child != children.rend(); ++child)
            open.push_back({*child, matrix, hidden});
    }
}

void GltfScene::sayWhatIsLeftOut() const {
    const GltfJson &nodes = mFile.list("nodes"), &scenes = mFile.list("scenes");
    if (mHidden > 0)
        mFile.say(MessageLevel::Note, countText(mHidden, "hidden node") + " with a mesh left out");
    std::vector<char> inScenes = mReached;
    for (std::size_t i = 0; i < scenes.size(); ++i)
        mark(mFile, mFile.indices(mFile.item("scenes", std::int64_t(i), "a scene"), "nodes"), inScenes);
    std::size_t others = 0, loose = 0;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        if (mReached[i] || mFile.index(nodes[i], "mesh") < 0) continue;
        inScenes[i] ? ++others : ++loose;
    }
    if (scenes.size() > 1)
        mFile.say(MessageLevel::Note, "its default scene is read; " +
                                          countText(scenes.size() - 1, "other scene") + " with " +
                                          countText(others, "node") +
                                          " of meshes left out; save each scene as a file of its own");
    if (loose > 0)
        mFile.say(MessageLevel::Note, countText(loose, "node") + " with a mesh in no scene left out; add " +
                                          (loose == 1 ? "it" : "them") + " to the scene to have " +
                                          (loose == 1 ? "it" : "them"));
}

Affine GltfScene::globalOf(std::int64_t node) const {
    mFile.item("nodes", node, "a joint");
    std::vector<std::int64_t> above;
    std::int64_t at = node;
    while (at >= 0 && !mKnown[std::size_t(at)]) {
        above.push_back(at);
        at = mParents[std::size_t(at)];
        if (above.size() > mKnown.size()) mFile.refuse("its nodes are not a tree");
    }
    for (; !above.empty(); above.pop_back()) {
        const std::int64_t next = above.back();
        const Affine parent = at < 0 ? kIdentity : mGlobal[std::size_t(at)];
        mGlobal[std::size_t(next)] = multiplied(parent, matrixOf(mFile, mFile.item("nodes", next, "a node")));
        mKnown[std::size_t(next)] = 1;
        at = next;
    }
    return mGlobal[std::size_t(node)];
}

std::vector<Affine> gltfInstances(const GltfFile& file, const GltfJson& node) {
    const GltfJson* extension = gltfExtension(node, "EXT_mesh_gpu_instancing");
    if (!extension) return {kIdentity};
    const GltfJson* attributes = gltfMember(*extension, "attributes");
    std::map<std::string, GltfValues> values;
    std::size_t count = 0;
    for (const auto& [name, width] :
         {std::pair("TRANSLATION", 3), std::pair("ROTATION", 4), std::pair("SCALE", 3)}) {
        const std::int64_t accessor = attributes ? file.index(*attributes, name) : -1;
        if (accessor < 0) continue;
        GltfValues read = gltfValues(file, accessor);
        if (read.width != std::size_t(width))
            file.refuse(std::string(name) + " of its instances is not a vector of " + std::to_string(width));
        if (!values.empty() && read.count != count)
            file.refuse(std::string(name) + " of its instances has " + std::to_string(read.count) +
                        " values, others have " + std::to_string(count));
        count = read.count;
        values.emplace(name, std::move(read));
    }
    if (values.empty()) {
        file.say(MessageLevel::Note, "a node's instances have no places; its mesh is read once");
        return {kIdentity};
    }
    const auto row = [&](const char* name, std::size_t i) -> const double* {
        const auto found = values.find(name);
        return found == values.end() ? nullptr : &found->second.numbers[i * found->second.width];
    };
    std::vector<Affine> instances;
    for (std::size_t i = 0; i < count; ++i)
        instances.push_back(composed(row("TRANSLATION", i), row("ROTATION", i), row("SCALE", i)));
    return instances;
}

}  // namespace vdbsynth
