// SPDX-License-Identifier: GPL-3.0-or-later
//
// An application can receive progress of binding, and may cancel it.
#include "Shapes.h"

#include <osgSkinBind/Bind>
#include <osgSkinBind/Progress>

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>
#include <string>
#include <vector>

using namespace osgSkin;

namespace {

struct Recorder {
    std::vector<std::string> whats;
    std::vector<double> fractions;
    Progress progress() {
        return [this](const ProgressStep& step) {
            whats.push_back(step.what);
            fractions.push_back(step.fraction);
        };
    }
};

} // namespace

TEST(Progress, SubProgressMapsIntoItsRange) {
    Recorder recorder;
    const Progress part = subProgress(recorder.progress(), 0.25, 0.75, "binding");
    part({"welding", 0.0});
    part({"bends", 0.5});
    subProgress(part, 0.5, 1.0)({"last bend", 0.5});
    part({"done", 1.0});
    EXPECT_EQ(recorder.whats, (std::vector<std::string>{"binding: welding", "binding: bends",
                                                        "binding: last bend", "binding: done"}));
    EXPECT_EQ(recorder.fractions, (std::vector<double>{0.25, 0.5, 0.625, 0.75}));
}

TEST(Progress, SubProgressOfNullIsNull) {
    EXPECT_FALSE(subProgress({}, 0.0, 1.0));
}

TEST(Progress, BindingRisesFromZeroToOne) {
    for (const BindOptions::Method method :
         {BindOptions::Method::Smooth, BindOptions::Method::Paper}) {
        Recorder recorder;
        BindOptions options;
        options.method = method;
        options.progress = recorder.progress();
        bind(shapes::cylinder(), shapes::chainAlongY({1.1, 4.1}, 7.0), options);
        ASSERT_GE(recorder.fractions.size(), 6u);
        EXPECT_EQ(recorder.fractions.front(), 0.0);
        EXPECT_EQ(recorder.fractions.back(), 1.0);
        EXPECT_TRUE(std::is_sorted(recorder.fractions.begin(), recorder.fractions.end()));
    }
}

TEST(Progress, ExceptionCancelsBinding) {
    BindOptions options;
    options.progress = [](const ProgressStep& step) {
        if (step.what == "flooding") throw std::runtime_error("cancelled");
    };
    EXPECT_THROW(bind(shapes::cylinder(), shapes::chainAlongY({1.1, 4.1}, 7.0), options),
                 std::runtime_error);
}
