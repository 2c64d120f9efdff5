#pragma once
#include "libvdbsynth/pipeline/patch/patch_map.h"
#include "libvdbsynth/pipeline/patch/patch_onto_map.h"
#include "libvdbsynth/pipeline/patch/patch_outputs.h"
#include "tools/vdb_synth/command.h"

namespace vdbsynth::cli {

/// How an exemplar is read, from the options. @throw Error InvalidOption
PatchSourceOptions patchSourceOptions(const Run& run);

/// patch EXEMPLAR --onto MODEL. @throw Error InvalidOption (options of sheets), and as patchOnto
void patchOntoModel(Run& run);

/// patch [EXEMPLAR --keep] SHEET --hole BOX|MODEL. @throw Error InvalidOption (options of sheets and models),
/// and as repairSheet
void repairWithPatches(Run& run);

/// What was warped at borders, for the report.
void countBorders(Run& run, const BorderStats& borders);

/// Writes a sheet's level set, or what writeModel makes of it, with what its points carry.
/// @throw Error as sheetLevelSet, writeModel
void writeSheetModels(Run& run, const std::vector<std::string>& paths, const PatchSource& source,
                      const PatchSheet& sheet, const PointCloud& cloud);

/// Writes a sheet to every -o: .ply its points, all others the level set or what writeModel makes of it.
/// @throw Error as sheetLevelSet, writeModel
void writeSheet(Run& run, const PatchSource& source, const PatchSheet& sheet);

/// The exemplar of repeat MAP EXEMPLAR, read as a map says; reserves the outputs.
/// @throw Error ShapeMismatch (other inputs), and as loadPatchSource
PatchSource loadRepeated(Run& run, const PatchBox& box, PatchPlane plane);

/// repeat MAP EXEMPLAR for a map of patches over a model, without the model. @throw Error as repeatPatchMap
void repeatPatchOntoMap(Run& run, const PatchOntoMapFile& map);

/// repeat MAP EXEMPLAR for a map of patches.
/// @throw Error ShapeMismatch, and as loadPatchSource
void repeatPatchMap(Run& run, const PatchMapFile& map);

}  // namespace vdbsynth::cli
