#pragma once
#include "libvdbsynth/io/png_file.h"
#include "libvdbsynth/pipeline/render/shown_model.h"

#include <cstddef>
#include <functional>

namespace vdbsynth {

/// Draws models side by side: level sets shaded (render/preview.h) or as slices (render/slice.h), fog as fog
/// (render/fog.h), each in a picture of `options.size`, in rows of `options.columns`, with its caption below.
/// A caption of characters without a letter is said in a note.
/// @param models  how many, at least 1
/// @param load    gives the models in turn, from 0; what a picture does not need of one is dropped before the
/// next is asked for
/// @param take    is given the picture, or those of a turntable in turn, numbered from 1; rows from the top;
/// four channels on a transparent background, else three
/// @throw Error   as validate (before any model is asked for); InvalidOption (fog with `slice`, `wireframe`
/// or `directions`; a picture over 65535 pixels wide or high), BadData (no attribute named `color`, or
/// colours of another type), EmptyInput, Memory, Cancelled; what `load` and `take` throw
/// @par Cost      as drawingOf or drawingOfFog for each model and picture; memory for what all models of a
/// row need to be drawn
/// @par Repeats   same bits for any number of threads
void renderModels(std::size_t models, const std::function<ShownModel(std::size_t)>& load,
                  const RenderOptions& options,
                  const std::function<void(int number, const Picture& picture)>& take,
                  const RunContext& ctx = {});

}  // namespace vdbsynth
