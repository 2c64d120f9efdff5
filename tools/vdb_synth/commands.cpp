#include "tools/vdb_synth/command.h"

namespace vdbsynth::cli {

const std::vector<const Command*>& commands() {
    static const std::vector<const Command*> all{
        &kConvert, &kInfo,    &kCrop,   &kMask, &kMatch,  &kSynth,         &kAnalogy, &kPatch, &kTexture,
        &kRepeat,  &kCompare, &kRender, &kMake, &kRelief, &kReliefExtract, &kBatch,   &kDoctor};
    return all;
}

const Command* findCommand(const std::string& name) {
    for (const Command* command : commands())
        if (command->name == name) return command;
    return nullptr;
}

}  // namespace vdbsynth::cli
