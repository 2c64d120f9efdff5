#pragma once
#include "libvdbsynth/render/camera.h"
#include "libvdbsynth/render/packed_mesh.h"

#include <string>
#include <vector>

namespace vdbsynth::cli {

/// A model of a page that turns it.
struct PageModel {
    std::string name;
    PackedMesh mesh;
    UpAxis up = UpAxis::Z;
    Vec3d view;  ///< [world] from the model to the camera, at first
};

/// What a page with viewers needs once: its style, the bar that cuts the models, and after all figures the
/// script. The script sets `data-viewers` of the body to the number of viewers that drew and, where the
/// address ends in #check, `data-drawn` of each figure to how many pixels its model covers; where WebGL is
/// missing, `data-drawn` is "none" and a picture in the figure stays. The address may also say
/// #cut=x,0.5&turn=1 (radians).
extern const char* const kViewerStyle;
extern const char* const kViewerBar;
extern const char* const kViewerScript;

/// A figure that the script makes a viewer of.
/// @param inside  HTML to show where there is no WebGL
std::string viewerFigure(const PageModel& model, const std::string& inside);

/// A self-contained page that shows models side by side: drag to turn, wheel to come nearer, shift or the
/// right button to move, a plane to cut.
std::string viewPage(const std::vector<PageModel>& models);

}  // namespace vdbsynth::cli
