#include "tools/vdb_synth/batch/status_page.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/base/printable_text.h"
#include "libvdbsynth/io/path.h"
#include "libvdbsynth/io/readers/whole_file.h"
#include "tools/vdb_synth/html_text.h"

#include <algorithm>

namespace vdbsynth::cli::batch {
namespace {

const char* kHead = R"(<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width">
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; img-src data:; style-src 'unsafe-inline'">
<style>
body { font: 15px/1.45 system-ui, sans-serif; margin: 2em auto; max-width: 1100px; padding: 0 1em; color: #1c2228; background: #fff }
h1 { font-size: 1.4em } table { border-collapse: collapse; width: 100% }
th, td { text-align: left; vertical-align: top; padding: .3em .6em; border-bottom: 1px solid #dfe4e8; font-variant-numeric: tabular-nums }
th { font-weight: 600; color: #55606a } td.number, th.number { text-align: right } td.error { overflow-wrap: anywhere }
.done, .current { color: #17693b } .failed, .blocked, .stopped { color: #a62b1f; font-weight: 600 } .running { color: #2166ac; font-weight: 600 } .waiting { color: #55606a }
img { max-width: 200px; height: auto; border: 1px solid #dfe4e8; margin-right: .4em } .sum { font-size: 1.15em; padding: .5em .8em; background: #f2f5f7 }
</style>)";

constexpr JobState kStates[] = {JobState::Running, JobState::Waiting, JobState::Done,   JobState::Current,
                                JobState::Failed,  JobState::Blocked, JobState::Stopped};

std::string classOf(JobState state) {
    return state == JobState::Current ? "current" : wordFor(state);
}

std::string pictureOf(const std::string& path, std::map<std::string, std::string>& pictures) {
    auto known = pictures.find(path);
    if (known == pictures.end()) try {
            known = pictures.insert({path, base64Text(readWholeFile(path))}).first;
        } catch (const Error&) {
            return "";  // removed since
        }
    return "<img alt=\"" + htmlText(printableText(fileNameOf(path))) + "\" src=\"data:image/png;base64," +
           known->second + "\">";
}

std::string row(const Job& job, const JobStatus& status, std::map<std::string, std::string>& pictures) {
    const bool ran = status.seconds > 0;
    std::string html = "<tr><td>" + htmlText(job.name) + "</td><td class=\"" + classOf(status.state) + "\">" +
                       wordFor(status.state) + "</td><td class=\"number\">" +
                       (ran ? fixedText(status.seconds, 1) : "") + "</td><td class=\"number\">" +
                       (status.peakBytes > 0 ? fixedText(double(status.peakBytes) / 1e6, 0) : "") +
                       "</td><td>";
    for (const std::string& picture : status.pictures) html += pictureOf(picture, pictures);
    return html + "</td><td class=\"error\">" + htmlText(printableText(status.error)) + "</td></tr>\n";
}

}  // namespace

std::string countsText(const std::vector<JobStatus>& status) {
    std::string text;
    for (const JobState state : kStates) {
        const auto count = std::count_if(status.begin(), status.end(),
                                         [&](const JobStatus& one) { return one.state == state; });
        if (count > 0) text += (text.empty() ? "" : ", ") + std::to_string(count) + " " + wordFor(state);
    }
    return text;
}

std::string statusPage(const Plan& plan, const std::vector<JobStatus>& status,
                       std::map<std::string, std::string>& pictures) {
    const bool open = std::any_of(status.begin(), status.end(), [](const JobStatus& one) {
        return one.state == JobState::Waiting || one.state == JobState::Running;
    });
    const std::string title = htmlText(printableText(fileNameOf(plan.path)));
    std::string html = kHead + std::string(open ? "<meta http-equiv=\"refresh\" content=\"5\">" : "") +
                       "<title>" + title + "</title></head><body>\n<h1>" + title +
                       "</h1>\n<p class=\"sum\">" + countsText(status) +
                       "</p>\n<table><tr><th>job</th><th>state</th><th class=\"number\">seconds</th>"
                       "<th class=\"number\">memory (MB)</th><th>results</th><th>error</th></tr>\n";
    for (std::size_t i = 0; i < status.size(); ++i) html += row(plan.jobs[i], status[i], pictures);
    return html + "</table>\n</body></html>\n";
}

}  // namespace vdbsynth::cli::batch
