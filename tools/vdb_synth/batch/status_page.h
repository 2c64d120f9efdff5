#pragma once
#include "tools/vdb_synth/batch/job_run.h"

#include <map>
#include <string>
#include <vector>

namespace vdbsynth::cli::batch {

/// A self-contained page with a row a job: state, seconds, memory, pictures, the error line. It asks the
/// browser to read it again every 5 seconds while jobs are open. All text is escaped.
/// @param pictures  as base64, by their PNG file; what is not there is read and kept
std::string statusPage(const Plan& plan, const std::vector<JobStatus>& status,
                       std::map<std::string, std::string>& pictures);

/// "3 done, 1 up to date, 1 failed": states that occur, in a fixed order.
std::string countsText(const std::vector<JobStatus>& status);

}  // namespace vdbsynth::cli::batch
