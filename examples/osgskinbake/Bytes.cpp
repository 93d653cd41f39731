// SPDX-License-Identifier: GPL-3.0-or-later
#include "Bytes.h"

#include "WholeFile.h"

namespace bake {

void writeBytes(const std::string& file, const std::string& data) {
    WholeFile out(file);
    out.write(data);
    out.finish();
}

} // namespace bake
