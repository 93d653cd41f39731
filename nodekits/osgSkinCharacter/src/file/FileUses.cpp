// SPDX-License-Identifier: GPL-3.0-or-later
#include "file/FileUses.h"

#include <filesystem>
#include <system_error>

namespace osgSkin {

void FileUses::add(const std::string& file, const JsonReader& place) {
    std::error_code failure;
    const std::string path = std::filesystem::weakly_canonical(file, failure).string();
    if (++_uses[failure ? file : path] > _most)
        place.failWith("names " + file + " once more, expected at most " + std::to_string(_most) +
                       " times (option maxUses)");
}

} // namespace osgSkin
