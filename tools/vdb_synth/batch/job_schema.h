#pragma once
#include "tools/vdb_synth/batch/job_text.h"

namespace vdbsynth::cli::batch {

/// A JSON schema (draft 7) of job files, made from the table of options: editors complete and check keys,
/// commands, options and their values with it. A text with ${ passes everywhere, as variables are filled in
/// later.
Json jobSchema();

}  // namespace vdbsynth::cli::batch
