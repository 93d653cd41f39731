// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapes/MergeCorrectives.h"

namespace osgSkin {
namespace {

/// Appends a vertex's entries of `from`, whose joints stand behind `firstJoint` others.
void append(const Correctives& from, std::size_t vertex, std::size_t firstJoint, Correctives& to) {
    for (std::uint32_t i = from.firstEntry[vertex]; i < from.firstEntry[vertex + 1]; ++i) {
        const Correctives::Entry& entry = from.entries[i];
        to.entries.push_back({static_cast<std::uint32_t>(firstJoint + entry.joint),
                              static_cast<std::uint32_t>(to.shares.size())});
        const auto first = from.shares.begin() + entry.firstShare;
        to.shares.insert(to.shares.end(), first,
                         first + static_cast<std::ptrdiff_t>(from.sharesOf(entry.joint)));
    }
}

} // namespace

Correctives mergeCorrectives(const Correctives& a, const Correctives& b) {
    if (a.empty()) return b;
    if (b.empty()) return a;
    Correctives result;
    result.joints = a.joints;
    result.inputs = a.inputs;
    for (CorrectiveJoint joint : b.joints) {
        if (joint.basis == CorrectiveJoint::Basis::Input)
            joint.joint += static_cast<std::uint32_t>(a.inputs.size());
        result.joints.push_back(joint);
    }
    result.inputs.insert(result.inputs.end(), b.inputs.begin(), b.inputs.end());
    result.firstEntry.push_back(0);
    for (std::size_t v = 0; v + 1 < a.firstEntry.size(); ++v) {
        append(a, v, 0, result);
        append(b, v, a.joints.size(), result);
        result.firstEntry.push_back(static_cast<std::uint32_t>(result.entries.size()));
    }
    return result;
}

} // namespace osgSkin
