// YAML as JSON, through yaml-cpp.
#include "tools/vdb_synth/batch/job_text.h"

#include "libvdbsynth/base/error.h"

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

#include <sstream>

namespace vdbsynth::cli::batch {
namespace {

constexpr int kDeepest = 64;
constexpr std::size_t kMostValues = 1000000;

class Converter {
public:
    explicit Converter(std::string path) : mPath(std::move(path)) {}

    Json convert(const YAML::Node& node, int depth) {
        if (depth > kDeepest) fail(node, "is nested too deeply for a job file");
        // Aliases of aliases: a few lines stand for billions of values.
        if (++mValues > kMostValues) fail(node, "stands for more than a million values");
        switch (node.Type()) {
            case YAML::NodeType::Sequence: {
                Json list = Json::array();
                for (const YAML::Node& item : node) list.push_back(convert(item, depth + 1));
                return list;
            }
            case YAML::NodeType::Map:
                return object(node, depth);
            case YAML::NodeType::Scalar:
                return scalar(node);
            default:
                return nullptr;
        }
    }

private:
    [[noreturn]] void fail(const YAML::Node& node, const std::string& what) const {
        throw Error(ErrorCode::BadData,
                    mPath + ": line " + std::to_string(node.Mark().line + 1) + ": " + what);
    }

    Json object(const YAML::Node& node, int depth) {
        Json made = Json::object();
        for (const auto& entry : node) {
            if (!entry.first.IsScalar()) fail(entry.first, "a key must be a word");
            const std::string key = entry.first.Scalar();
            if (key == "<<") fail(entry.first, "merged keys (<<) are not read; use \"defaults\"");
            if (made.contains(key)) fail(entry.first, "\"" + key + "\" stands twice; keep one of them");
            made[key] = convert(entry.second, depth + 1);
        }
        return made;
    }

    static Json scalar(const YAML::Node& node) {
        const std::string& word = node.Scalar();
        if (node.Tag() == "!") return word;  // in quotes
        if (word == "true" || word == "True" || word == "TRUE") return true;
        if (word == "false" || word == "False" || word == "FALSE") return false;
        if (word.empty() || word == "null" || word == "~") return nullptr;
        return word;
    }

    std::string mPath;
    std::size_t mValues = 0;
};

// Parses without keeping anything. A damaged file can make yaml-cpp give values without end, and it would
// keep them all.
class Count : public YAML::EventHandler {
public:
    explicit Count(const std::string& path) : mPath(path) {}

    void OnDocumentStart(const YAML::Mark&) override {
        if (++mDocuments > 1)
            throw Error(
                ErrorCode::BadData,
                mPath +
                    ": holds several documents, or a comma or bracket too many; a job file is one document");
    }
    void OnDocumentEnd() override {}
    void OnNull(const YAML::Mark& mark, YAML::anchor_t) override { value(mark); }
    void OnAlias(const YAML::Mark& mark, YAML::anchor_t) override { value(mark); }
    void OnScalar(const YAML::Mark& mark, const std::string&, YAML::anchor_t, const std::string&) override {
        value(mark);
    }
    void OnSequenceStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t,
                         YAML::EmitterStyle::value) override {
        value(mark);
    }
    void OnSequenceEnd() override {}
    void OnMapStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t,
                    YAML::EmitterStyle::value) override {
        value(mark);
    }
    void OnMapEnd() override {}

private:
    void value(const YAML::Mark& mark) {
        if (++mValues > kMostValues)
            throw Error(ErrorCode::BadData,
                        mPath + ": line " + std::to_string(mark.line + 1) +
                            ": more than a million values, or quotes and brackets that do not match");
    }

    const std::string& mPath;
    std::size_t mDocuments = 0, mValues = 0;
};

}  // namespace

Json parseYaml(const std::string& path, const std::string& text) {
    // Texts of job files are written into JSON later, which holds nothing else.
    try {
        (void)Json(text).dump();
    } catch (const Json::exception&) {
        throw Error(ErrorCode::BadData, path + ": is not UTF-8; save it as such");
    }
    try {
        std::istringstream stream(text);
        YAML::Parser parser(stream);
        Count count(path);
        while (parser.HandleNextDocument(count)) {
        }
        const std::vector<YAML::Node> documents = YAML::LoadAll(text);
        if (documents.empty())
            throw Error(ErrorCode::BadData, path + ": holds nothing; a job file has \"jobs\"");
        return Converter(path).convert(documents.front(), 0);
    } catch (const YAML::Exception& error) {
        const std::string place = error.mark.is_null()
                                      ? ""
                                      : "at line " + std::to_string(error.mark.line + 1) + ", column " +
                                            std::to_string(error.mark.column + 1) + ": ";
        throw Error(ErrorCode::BadData, path + ": no valid YAML: " + place + error.msg);
    }
}

}  // namespace vdbsynth::cli::batch
