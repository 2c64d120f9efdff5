#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <sstream>
#include <string>
#include <vector>

// STL files of a box of 2 x 3 x 4 at (1, 2, 3): 12 triangles, 8 corners.
namespace vdbsynth::test {

using StlFacet = std::array<std::array<float, 3>, 3>;

inline std::vector<StlFacet> boxFacets() {
    const auto corner = [](int i) {
        return std::array<float, 3>{i & 1 ? 3.f : 1.f, i & 2 ? 5.f : 2.f, i & 4 ? 7.f : 3.f};
    };
    const int quads[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                             {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    std::vector<StlFacet> facets;
    for (const auto& q : quads) {
        facets.push_back({corner(q[0]), corner(q[1]), corner(q[2])});
        facets.push_back({corner(q[0]), corner(q[2]), corner(q[3])});
    }
    return facets;
}

inline std::string stlNumber(const void* value, std::size_t bytes, bool bigEndian) {
    std::string text(static_cast<const char*>(value), bytes);
    if (bigEndian) std::reverse(text.begin(), text.end());
    return text;
}

/// A binary STL file. @param count  that the header claims
inline std::string binaryStl(const std::vector<StlFacet>& facets, std::uint32_t count, bool bigEndian = false,
                             const std::string& header = "exporter", const std::string& attribute = "") {
    std::string text = header;
    text.resize(80, '\0');
    text += stlNumber(&count, 4, bigEndian);
    for (const StlFacet& facet : facets) {
        text += std::string(12, '\0');
        for (const auto& p : facet)
            for (const float value : p) text += stlNumber(&value, 4, bigEndian);
        text += attribute.empty() ? std::string(2, '\0') : attribute;
    }
    return text;
}

/// The body of an ascii STL file, without the lines of the solid.
inline std::string stlFacets(const std::vector<StlFacet>& facets) {
    std::ostringstream text;
    for (const StlFacet& facet : facets) {
        text << "facet normal 0 0 0\nouter loop\n";
        for (const auto& p : facet) text << "vertex " << p[0] << ' ' << p[1] << ' ' << p[2] << '\n';
        text << "endloop\nendfacet\n";
    }
    return text.str();
}

inline std::string asciiStl(const std::string& name = "box") {
    return "solid " + name + "\n" + stlFacets(boxFacets()) + "endsolid " + name + "\n";
}

inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
    for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
        text.replace(at, from.size(), to);
    return text;
}

}  // namespace vdbsynth::test
