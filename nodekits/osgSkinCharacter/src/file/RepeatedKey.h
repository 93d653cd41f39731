// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <string>

namespace osgSkin {

/// A member that an object of a JSON text has twice, of which its parser keeps the last.
struct RepeatedKey {
    std::string key;      ///< as the text spells it, without quotes
    std::size_t byte = 0; ///< where the second one begins

    /// The first one in a text.
    /// \param text valid JSON
    static std::optional<RepeatedKey> find(const std::string& text);
};

} // namespace osgSkin
