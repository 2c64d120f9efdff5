// A page that turns models in a browser. Its script, without a library, is in view_page_script.cpp.
#include "tools/vdb_synth/view_page.h"

#include "libvdbsynth/base/number_text.h"
#include "tools/vdb_synth/html_text.h"

#include <nlohmann/json.hpp>

namespace vdbsynth::cli {
namespace {

const char* kHead = R"(<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width">
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; img-src data:; style-src 'unsafe-inline'; script-src 'unsafe-inline'">
<style>
html, body { height: 100%; margin: 0 } body { display: flex; flex-direction: column; font: 14px/1.4 system-ui, sans-serif; color: #22272e; background: #e9ebee }
main { flex: 1; min-height: 0; display: grid; grid-auto-flow: column; grid-auto-columns: 1fr; gap: 1px }
figure.viewer { margin: 0; min-height: 0; display: flex; flex-direction: column } figure.viewer canvas { flex: 1; min-height: 0; width: 100% }
figcaption { padding: .3em .8em; text-align: center }
)";

nlohmann::json numbers(const Vec3d& v) {
    return {v.x, v.y, v.z};
}

}  // namespace

std::string viewerFigure(const PageModel& model, const std::string& inside) {
    const PackedMesh& mesh = model.mesh;
    const nlohmann::json about{{"vertices", mesh.vertices},  {"triangles", mesh.triangles},
                               {"low", numbers(mesh.low)},   {"high", numbers(mesh.high)},
                               {"coloured", mesh.coloured},  {"up", model.up == UpAxis::Y ? "y" : "z"},
                               {"view", numbers(model.view)}};
    return "<figure class=\"viewer\" data-mesh=\"" + htmlText(about.dump()) + "\">" + inside +
           "<script type=\"text/plain\">" +
           base64Text(mesh.positions + mesh.normals + mesh.open + mesh.colours + mesh.corners) + "</script>";
}

std::string viewPage(const std::vector<PageModel>& models) {
    std::string title, figures;
    for (const PageModel& model : models) {
        title += (title.empty() ? "" : ", ") + model.name;
        std::string text = htmlText(model.name) + ": " + std::to_string(model.mesh.triangles) + " triangles";
        if (model.mesh.triangles < model.mesh.before) text += " of " + std::to_string(model.mesh.before);
        figures += viewerFigure(model, "<noscript>This page needs JavaScript.</noscript>") + "<figcaption>" +
                   text + "</figcaption></figure>\n";
    }
    return kHead + std::string(kViewerStyle) + "</style>\n<title>" + htmlText(title) +
           "</title></head><body>\n<main>\n" + figures + "</main>\n" + kViewerBar + kViewerScript +
           "\n</body></html>\n";
}

}  // namespace vdbsynth::cli
