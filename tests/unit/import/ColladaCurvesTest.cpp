// SPDX-License-Identifier: MIT
#include "assimp/ColladaCurves.h"

#include "ExpectError.h"
#include "Notices.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <iterator>
#include <map>
#include <sstream>
#include <string>
#include <vector>

namespace {

/// Samples of a Collada curve from (0, 0) to (1, 120) that moves a node's angle.
/// \param kind of its interpolation
/// \param out, in tangents: two numbers for each key
/// \param numbers of each key, of which the first counts
std::map<double, double> samplesOf(const std::string& kind, const std::string& out,
                                   const std::string& in, double end = 1.0, int numbers = 1,
                                   const std::string& target = "Tip/rotateZ.ANGLE") {
    const auto array = [](const char* id, const std::string& words, int count, int stride) {
        const std::string number = std::to_string(count), tag = id[0] == 'k' ? "Name" : "float";
        return std::string("<source id='") + id + "'><" + tag + "_array count='" + number + "'>" +
               words + "</" + tag + "_array><technique_common><accessor count='" +
               std::to_string(count / stride) + "' stride='" + std::to_string(stride) +
               "'/></technique_common></source>";
    };
    std::ostringstream last;
    last << "0 " << end;
    std::string more;
    for (int k = 1; k < numbers; ++k) more += " 0";
    std::string bytes = "<library_animations><animation>" + array("t", last.str(), 2, 1) +
                        array("v", "0" + more + " 120" + more, 2 * numbers, numbers) +
                        array("k", kind + " " + kind, 2, 1) + array("o", out, 4, 2) +
                        array("i", in, 4, 2) +
                        "<sampler id='s'><input semantic='INPUT' source='#t'/>"
                        "<input semantic='OUTPUT' source='#v'/><input "
                        "semantic='INTERPOLATION' source='#k'/><input semantic='IN_TANGENT' "
                        "source='#i'/><input semantic='OUT_TANGENT' source='#o'/></sampler>"
                        "<channel source='#s' target='" +
                        target +
                        "'/></animation>"
                        "</library_animations>";
    osgSkin::applyEdits(osgSkin::sampleCurves("curve.dae", bytes, {}), bytes);
    const auto read = [&bytes](const char* id) {
        const std::size_t begin =
            bytes.find('>', bytes.find("_array", bytes.find(std::string("'") + id + "'"))) + 1;
        std::istringstream words(bytes.substr(begin, bytes.find('<', begin) - begin));
        return std::vector<double>(std::istream_iterator<double>(words), {});
    };
    const std::vector<double> times = read("t"), values = read("v");
    EXPECT_EQ(times.size() * std::size_t(numbers), values.size());
    const std::string count = "count='" + std::to_string(times.size()) + "'";
    std::size_t counts = 0;
    for (auto at = bytes.find(count); at != bytes.npos; at = bytes.find(count, at + 1)) ++counts;
    EXPECT_GE(counts, numbers == 1 ? 4u : 3u) << bytes;
    std::map<double, double> result;
    for (std::size_t k = 0; k < times.size(); ++k)
        result[times[k]] = values[k * std::size_t(numbers)];
    return result;
}

} // namespace

/// A Hermite curve's tangents are three times as long as a Bezier curve's.
TEST(ColladaCurves, AreSampledAsTheFileSays) {
    for (const bool isHermite : {false, true}) {
        const auto samples = isHermite ? samplesOf("HERMITE", "1.2 0 1 0", "1 0 1.2 0")
                                       : samplesOf("BEZIER", "0.4 0 1.3 120", "-0.3 0 0.6 120");
        ASSERT_EQ(samples.size(), 31u) << isHermite;
        for (const auto& [time, angle] : samples) {
            double t = 0.0; // where the curve x = 1.2 s^2 t + 1.8 s t^2 + t^3 is
            for (double step = 0.5; step > 1e-12; step *= 0.5) {
                const double u = t + step, s = 1.0 - u;
                if (1.2 * s * s * u + 1.8 * s * u * u + u * u * u < time) t = u;
            }
            EXPECT_NEAR(angle, 120.0 * t * t * (3.0 - 2.0 * t), 1e-6) << time;
        }
    }
    for (const int numbers : {1, 16}) { // an angle, a matrix
        const auto steps = samplesOf("STEP", "0 0 0 0", "0 0 0 0", 1.0, numbers);
        EXPECT_EQ(steps.at(1.0), 120.0);
        EXPECT_EQ(std::prev(steps.end(), 2)->second, 0.0);
        EXPECT_GT(std::prev(steps.end(), 2)->first, 0.99);
    }
    expectError([] { samplesOf("LINEAR", "0 0 0 0", "0 0 0 0", 1e9); }, "option maxSamples");
}

TEST(ColladaCurves, AreReadAsLinesWhereTheNoticeSaysSo) {
    const auto noticesOf = [](const char* kind, double end) {
        const test::Notices notices;
        EXPECT_EQ(samplesOf(kind, "0 0 0 0", "0 0 0 0", end).size(), 2u);
        return notices.text();
    };
    EXPECT_NE(noticesOf("CARDINAL", 1.0).find("are read as straight lines"), std::string::npos);
    EXPECT_EQ(noticesOf("CARDINAL", 0.04), "") << "dense";
}

TEST(ColladaCurves, OfAxisAndAngleTogetherAreTold) {
    for (const std::string target : {"Tip/rotateZ", "Tip/rotateZ.ANGLE"}) {
        const bool isWhole = target == "Tip/rotateZ";
        const test::Notices notices;
        samplesOf("LINEAR", "0 0 0 0", "0 0 0 0", 1.0, isWhole ? 4 : 1, target);
        EXPECT_EQ(notices.say("\"Tip/rotateZ\", of axis and angle together"), isWhole)
            << notices.text();
    }
}
