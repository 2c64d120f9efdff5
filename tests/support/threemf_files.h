#pragma once
#include "libvdbsynth/io/package/zip_file.h"

#include <map>
#include <string>

namespace vdbsynth::test {

// Small 3MF packages, part by part, for tests.

inline const char* const kThreemfRelations =
    R"(<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships"><Relationship )"
    R"(Target="/3D/3dmodel.model" Id="r" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/>)"
    R"(</Relationships>)";

/// A package of these parts, as it is.
inline std::string package(const std::map<std::string, std::string>& parts) {
    ZipWriter zip;
    for (const auto& [name, text] : parts) zip.add(name, text);
    return zip.finish();
}

/// A whole model element. @param attributes  of it, before the resources
inline std::string threemfModelText(const std::string& resources, const std::string& build,
                                    const std::string& attributes = "unit=\"millimeter\"") {
    return "<?xml version=\"1.0\"?>\n<model " + attributes +
           R"( xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02")"
           R"( xmlns:m="http://schemas.microsoft.com/3dmanufacturing/material/2015/02")"
           R"( xmlns:p="http://schemas.microsoft.com/3dmanufacturing/production/2015/06")"
           R"( xmlns:b="http://schemas.microsoft.com/3dmanufacturing/beamlattice/2017/02"><resources>)" +
           resources + "</resources><build>" + build + "</build></model>";
}

/// A package of one model. @param more  further parts
inline std::string threemf(const std::string& resources, const std::string& build,
                           std::map<std::string, std::string> more = {},
                           const std::string& attributes = "unit=\"millimeter\"") {
    more["_rels/.rels"] = kThreemfRelations;
    more["3D/3dmodel.model"] = threemfModelText(resources, build, attributes);
    return package(more);
}

/// A tetrahedron of volume 1/6 with a corner at 0. @param more  attributes of its first triangle
inline std::string tetrahedron(const std::string& id, const std::string& attributes = "",
                               const std::string& more = "") {
    return "<object id=\"" + id + "\" " + attributes +
           "><mesh><vertices><vertex x=\"0\" y=\"0\" z=\"0\"/><vertex x=\"1\" y=\"0\" z=\"0\"/>"
           "<vertex x=\"0\" y=\"1\" z=\"0\"/><vertex x=\"0\" y=\"0\" z=\"1\"/></vertices><triangles>"
           "<triangle v1=\"0\" v2=\"2\" v3=\"1\" " +
           more +
           "/><triangle v1=\"0\" v2=\"1\" v3=\"3\"/><triangle v1=\"0\" v2=\"3\" v3=\"2\"/>"
           "<triangle v1=\"1\" v2=\"2\" v3=\"3\"/></triangles></mesh></object>";
}

/// A model of one of every kind of element that is read; another part holds object 7.
inline std::string fullThreemfModel() {
    return threemfModelText(
        R"(<basematerials id="1"><base name="a" displaycolor="#FF0000"/></basematerials>)"
        R"(<m:colorgroup id="2"><m:color color="#00FF0080"/><m:color color="#0000FF"/></m:colorgroup>)"
        R"(<m:multiproperties id="3" pids="1 2"><m:multi pindices="0 1"/></m:multiproperties>)" +
            tetrahedron("4", R"(pid="1" pindex="0")", R"(pid="2" p1="0" p2="1" p3="1")") +
            R"(<object id="5"><components><component objectid="4" transform="2 0 0 0 2 0 0 0 2 1 1 1"/>)"
            R"(<component objectid="7" p:path="/3D/b.model"/></components></object>)" +
            tetrahedron("7", R"(pid="3" pindex="0")"),
        R"(<item objectid="5" transform="1 0 0 0 1 0 0 0 -1 0 0 0"/>)");
}

inline std::string fullThreemf() {
    return package({{"_rels/.rels", kThreemfRelations},
                    {"3D/3dmodel.model", fullThreemfModel()},
                    {"3D/b.model", threemfModelText(tetrahedron("7", R"(pid="9")"), "")},
                    {"Metadata/Slic3r_PE_model.config",
                     R"(<config><object id="4"><volume firstid="9" lastid="12"><metadata key="volume_type" )"
                     R"(value="NegativeVolume"/></volume></object></config>)"}});
}

}  // namespace vdbsynth::test
