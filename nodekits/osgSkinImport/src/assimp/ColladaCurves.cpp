// SPDX-License-Identifier: MIT
#include "assimp/ColladaCurves.h"

#include "assimp/FbxCurve.h"
#include "files/FileText.h"

#include <algorithm>
#include <cmath>
#include <locale>
#include <set>
#include <sstream>
#include <vector>

namespace osgSkin {
namespace {

constexpr double kBeforeStep = 1e-3;  ///< seconds before a step: the last of the old value
constexpr std::size_t kMaxStride = 4; ///< more is a matrix, which may have steps alone
constexpr double kMinHandle = 1e-6;   ///< of a segment: a handle that points straight up

struct Source {
    std::optional<XmlValue> text, count, samples; ///< the array's, the array's, the accessor's
    std::size_t stride = 1;
};

/// A sampler's sources, by their semantic.
struct Sampler {
    std::map<std::string_view, std::string_view> inputs;
    bool isAngle = false;
    std::string_view whole; ///< what it moves, if that is not a single number

    std::string_view operator[](std::string_view semantic) const {
        const auto found = inputs.find(semantic);
        return found == inputs.end() ? std::string_view() : found->second;
    }
};

std::vector<std::string_view> wordsOf(std::string_view text) {
    std::vector<std::string_view> result;
    constexpr const char* kSpaces = " \t\r\n";
    for (std::size_t at = 0; (at = text.find_first_not_of(kSpaces, at)) != text.npos;) {
        const std::size_t end = std::min(text.find_first_of(kSpaces, at), text.size());
        result.push_back(text.substr(at, end - at));
        at = end;
    }
    return result;
}

/// The curves of a file.
class Curves {
public:
    Curves(const std::string& path, std::string_view xml, const ReadLimits& limits)
        : _path(path), _xml(xml), _samples(limits.samplesOf(xml.size())) {
        constexpr std::string_view kBegin = "<library_animations", kEnd = "</library_animations";
        for (std::size_t end = 0, at = 0; (at = xml.find(kBegin, end)) != xml.npos; read(at, end))
            end = std::min(xml.find(kEnd, at), xml.size());
    }

    TextEdits sample() {
        std::map<std::string_view, std::vector<const Sampler*>> byTimes;
        for (const auto& [id, sampler] : _samplers) {
            byTimes[sampler["INPUT"]].push_back(&sampler);
            const auto output = _sources.find(sampler["OUTPUT"]);
            if (!sampler.whole.empty() && output != _sources.end() && output->second.stride == 4)
                warn(_path, "the curve of \"" + std::string(sampler.whole) +
                                "\", of axis and angle together, is left out: export curves of "
                                "angles or matrices");
        }
        for (const auto& [times, samplers] : byTimes) sample(times, samplers);
        if (_isLeft)
            warn(_path, "curves that are neither BEZIER, HERMITE nor STEP, curves of matrices, "
                        "or curves without tangents for each key, are read as straight lines "
                        "between their keys: export a key for "
                        "each frame");
        return std::move(_edits);
    }

private:
    void read(std::size_t at, std::size_t end) {
        Source* source = nullptr;
        Sampler* sampler = nullptr;
        const auto attribute = [this](std::size_t tag, std::string_view name) {
            const auto value = findAttribute(_xml, tag, name);
            return value ? value->of(_xml) : std::string_view();
        };
        const auto target = [&](std::size_t tag) { // without its #
            const std::string_view url = attribute(tag, "source");
            return url.empty() ? url : url.substr(1);
        };
        for (at = _xml.find('<', at); at < end; at = _xml.find('<', at + 1)) {
            const std::string_view name =
                _xml.substr(at + 1, _xml.find_first_of(" \t\r\n/>", at + 1) - at - 1);
            if (name == "source") source = &_sources[attribute(at, "id")];
            if (name == "sampler") sampler = &_samplers[attribute(at, "id")];
            if (name == "channel" && _samplers.count(target(at)) != 0) {
                const std::string_view moved = attribute(at, "target");
                const std::size_t dot = moved.rfind('.');
                _samplers[target(at)].isAngle = dot != moved.npos && moved.substr(dot) == ".ANGLE";
                if (dot == moved.npos) _samplers[target(at)].whole = moved;
            }
            if (name == "input" && sampler != nullptr)
                sampler->inputs.emplace(attribute(at, "semantic"), target(at));
            if (source == nullptr) continue;
            if (name == "float_array" || name == "Name_array") {
                const std::size_t begin = std::min(_xml.find('>', at), end - 1) + 1;
                source->text = {begin, std::min(_xml.find('<', begin), end) - begin};
                source->count = findAttribute(_xml, at, "count");
            }
            if (name == "accessor") {
                source->samples = findAttribute(_xml, at, "count");
                double stride = 1.0;
                parseNumber(attribute(at, "stride"), stride);
                source->stride = stride >= 1.0 && stride <= 1000.0 ? std::size_t(stride) : 0;
            }
        }
    }

    /// A source's words; none if it does not exist or lacks what is edited.
    std::vector<std::string_view> words(std::string_view id) const {
        const auto source = _sources.find(id);
        if (source == _sources.end() || !source->second.text || !source->second.count ||
            !source->second.samples)
            return {};
        return wordsOf(source->second.text->of(_xml));
    }

    /// A source's numbers; none if one of them is none.
    std::vector<double> numbers(std::string_view id) const {
        std::vector<double> result;
        for (const std::string_view word : words(id))
            if (!parseNumber(word, result.emplace_back()) || !std::isfinite(result.back()))
                return {};
        return result;
    }

    /// Samples all curves with the same times.
    void sample(std::string_view input, const std::vector<const Sampler*>& samplers) {
        const std::vector<double> times = numbers(input);
        bool isSparse = false, isCurved = false, hasSteps = false;
        for (std::size_t k = 1; k < times.size(); ++k) {
            if (!(times[k] > times[k - 1])) return;
            isSparse = isSparse || times[k] - times[k - 1] > kDenseKeys;
        }
        if (!isSparse) return;
        for (const Sampler* const sampler : samplers) {
            isCurved = isCurved || sampler->isAngle;
            for (const std::string_view kind : words((*sampler)["INTERPOLATION"])) {
                isCurved = isCurved || kind != "LINEAR";
                hasSteps = hasSteps || kind == "STEP";
            }
        }
        if (!isCurved) return;
        std::map<std::string_view, std::vector<FbxCurve>> curves; // by output
        bool isFree = _sampled.insert(input).second;
        for (const Sampler* const sampler : samplers) {
            const std::string_view output = (*sampler)["OUTPUT"];
            if (curves.count(output) != 0) continue;
            std::vector<FbxCurve>& own = curves[output] = curvesOf(*sampler, times);
            isFree = _sampled.insert(output).second && isFree && !own.empty();
        }
        _isLeft = _isLeft || !isFree;
        if (!isFree) return;
        std::size_t numbers = 1; // of a sample
        for (const auto& [output, axes] : curves) numbers += axes.size();
        const std::vector<double> at = samplesOf(times, numbers, hasSteps);
        replace(input, at, {});
        for (const auto& [output, axes] : curves) replace(output, at, axes);
    }

    std::vector<double> samplesOf(const std::vector<double>& times, std::size_t numbers,
                                  bool hasSteps) {
        std::vector<double> result{times.front()};
        for (std::size_t k = 1; k < times.size(); ++k) {
            const double begin = times[k - 1], duration = times[k] - begin;
            const double pieces = std::ceil(duration / kSampleStep - 1e-6);
            if (!((pieces + 1.0) * double(numbers) < double(_samples)))
                failFile(_path, "a clip lasts " + std::to_string(duration) +
                                    " s between two keys, expected fewer samples (option "
                                    "maxSamples)");
            _samples -= std::size_t(pieces + 1.0) * numbers;
            for (double piece = 1.0; piece < pieces; piece += 1.0)
                result.push_back(begin + piece / pieces * duration);
            if (hasSteps && duration > 4.0 * kBeforeStep) result.push_back(times[k] - kBeforeStep);
            result.push_back(times[k]);
        }
        return result;
    }

    /// The curve of each of an output's numbers; none if they cannot be sampled.
    std::vector<FbxCurve> curvesOf(const Sampler& sampler, const std::vector<double>& times) const {
        const std::string_view output = sampler["OUTPUT"];
        const std::vector<std::string_view> kinds = words(sampler["INTERPOLATION"]);
        const std::vector<double> values = numbers(output), in = numbers(sampler["IN_TANGENT"]),
                                  out = numbers(sampler["OUT_TANGENT"]);
        const auto source = _sources.find(output);
        const std::size_t n = source == _sources.end() ? 0 : source->second.stride;
        const bool isSteps = kinds.size() == times.size() &&
                             std::all_of(kinds.begin(), kinds.end(),
                                         [](std::string_view kind) { return kind == "STEP"; });
        if (n == 0 || (n > kMaxStride && !isSteps) || values.size() != n * times.size()) return {};
        // Tangents have pairs of time and value, or values alone, a third of the time away.
        const std::size_t pair = out.size() == 2 * values.size() ? 2 : 1;
        std::vector<FbxCurve> result;
        for (std::size_t axis = 0; axis < n; ++axis) {
            std::vector<FbxCurve::Key> keys(times.size());
            for (std::size_t k = 0; k < keys.size(); ++k) {
                FbxCurve::Key& key = keys[k];
                key.time = times[k];
                key.value = values[n * k + axis];
                const std::string_view kind = k < kinds.size() ? kinds[k] : "LINEAR";
                if (kind == "STEP") key.kind = FbxCurve::Key::Kind::Constant;
                if (kind == "LINEAR" || kind == "STEP" || k + 1 == keys.size()) continue;
                const bool isHermite = kind == "HERMITE";
                if ((!isHermite && kind != "BEZIER") || out.size() != pair * values.size() ||
                    in.size() != out.size())
                    return {};
                const double next = values[n * (k + 1) + axis], duration = times[k + 1] - times[k];
                const std::size_t from = pair * (n * k + axis), to = from + pair * n;
                key.kind = FbxCurve::Key::Kind::Cubic;
                const double factor = isHermite ? 1.0 / 3.0 : 1.0;
                if (pair == 2) {
                    key.weight = (factor * out[from] - (isHermite ? 0.0 : times[k])) / duration;
                    key.nextWeight =
                        (isHermite ? factor * in[to] : times[k + 1] - in[to]) / duration;
                }
                key.weight = std::clamp(key.weight, kMinHandle, 1.0);
                key.nextWeight = std::clamp(key.nextWeight, kMinHandle, 1.0);
                const double rise = factor * out[from + pair - 1] - (isHermite ? 0.0 : key.value);
                const double fall =
                    isHermite ? factor * in[to + pair - 1] : next - in[to + pair - 1];
                key.slope = rise / (key.weight * duration);
                key.nextSlope = fall / (key.nextWeight * duration);
            }
            result.emplace_back(std::move(keys));
        }
        return result;
    }

    /// Replaces a source's array by its curves at some times, or by the times.
    void replace(std::string_view id, const std::vector<double>& times,
                 const std::vector<FbxCurve>& curves) {
        const Source& source = _sources.at(id);
        std::ostringstream text;
        text.imbue(std::locale::classic());
        text.precision(12);
        for (const double time : times) {
            if (curves.empty()) text << time << ' ';
            for (const FbxCurve& curve : curves) text << curve.at(time) << ' ';
        }
        const std::size_t n = std::max<std::size_t>(curves.size(), 1);
        _edits[source.text->begin] = {source.text->size, text.str()};
        _edits[source.count->begin] = {source.count->size, std::to_string(n * times.size())};
        _edits[source.samples->begin] = {source.samples->size, std::to_string(times.size())};
    }

    const std::string& _path;
    const std::string_view _xml;
    std::size_t _samples; ///< how many more numbers may be added
    std::map<std::string_view, Source> _sources;
    std::map<std::string_view, Sampler> _samplers;
    std::set<std::string_view> _sampled; ///< sources
    bool _isLeft = false;
    TextEdits _edits;
};

} // namespace

TextEdits sampleCurves(const std::string& path, std::string_view xml, const ReadLimits& limits) {
    return Curves(path, xml, limits).sample();
}

} // namespace osgSkin
