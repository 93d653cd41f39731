// SPDX-License-Identifier: MIT
#include "source/CharacterSource.h"

#include <osgSkin/Error>

#include <cmath>
#include <filesystem>
#include <locale>
#include <sstream>
#include <system_error>
#include <utility>

namespace osgSkin {

LoadStages::LoadStages(Progress progress) : _progress(std::move(progress)) {}

void LoadStages::plan(double total) {
    _total = total;
}

Progress LoadStages::begin(const std::string& what, double size) {
    _begun += _size;
    _size = size;
    if (_progress) _progress({what, _begun / _total});
    return subProgress(_progress, _begun / _total, (_begun + _size) / _total, what);
}

void LoadStages::finish() {
    if (_progress) _progress({"done", 1.0});
}

void MotionSamples::add(const std::string& file, std::size_t frames, std::size_t joints,
                        const ReadLimits& limits) {
    std::error_code failure;
    const std::string path = std::filesystem::weakly_canonical(file, failure).string();
    if (_files.insert(failure ? file : path).second) {
        const auto bytes = static_cast<std::size_t>(std::filesystem::file_size(file, failure));
        if (!failure) _bytes += bytes;
    }
    const std::size_t most = limits.samplesOf(_bytes);
    if (frames > (most - _samples) / joints) {
        const std::string others =
            _samples > 0 ? " beside " + std::to_string(_samples) + " rotations of other motions"
                         : "";
        throw Error(std::to_string(frames) + " frames for " + std::to_string(joints) + " joints" +
                    others + ", expected at most " + std::to_string(most) +
                    " rotations (option maxSamples)");
    }
    _samples += frames * joints;
}

double unitOf(double stated, const LoadOptions& options, const std::string& file,
              std::vector<std::string>& notes) {
    if (!options.unit) return stated > 0.0 ? stated : 1.0;
    const FileUnit& given = *options.unit;
    if (given.overridesFile || !(stated > 0.0)) return given.metres;
    if (std::abs(given.metres - stated) > 1e-6 * stated) {
        std::ostringstream note;
        note.imbue(std::locale::classic());
        note << file << ": states that its unit is " << stated
             << " m, so the option unit is not used; a number (\"unit\": " << given.metres
             << ") would replace it";
        warn(notes, note.str());
    }
    return stated;
}

} // namespace osgSkin
