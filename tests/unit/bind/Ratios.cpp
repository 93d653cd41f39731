// SPDX-License-Identifier: GPL-3.0-or-later
#include "Ratios.h"

#include <gtest/gtest.h>

void expectSound(const osgSkin::Binding& binding, std::size_t maxPartial) {
    ASSERT_NO_THROW(binding.validate());
    std::size_t overfull = 0, aboveParent = 0;
    for (std::size_t v = 0; v < binding.vertexCount(); ++v) {
        if (partialJoints(binding, v) > maxPartial) ++overfull;
        for (std::size_t j = 1; j < binding.joints.size(); ++j) {
            const auto parent = static_cast<std::size_t>(binding.joints[j].parent);
            const osgSkin::Influence own = ratiosOf(binding, v, j);
            const osgSkin::Influence above = ratiosOf(binding, v, parent);
            if (own.bend > above.bend || own.twist > above.twist) ++aboveParent;
        }
    }
    EXPECT_EQ(overfull, 0u) << "vertices with more than " << maxPartial << " partial joints";
    EXPECT_EQ(aboveParent, 0u) << "ratios above the parent's";
}
