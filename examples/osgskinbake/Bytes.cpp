// SPDX-License-Identifier: GPL-3.0-or-later
#include "Bytes.h"

#include <osgSkin/Error>

#include <fstream>

namespace bake {

void writeBytes(const std::string& file, const std::string& data) {
    std::ofstream out(file, std::ios::binary);
    out.write(data.data(), static_cast<std::streamsize>(data.size()));
    if (!out.flush()) throw osgSkin::Error(file + ": cannot be written, expected a writable file");
}

} // namespace bake
