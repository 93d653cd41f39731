// SPDX-License-Identifier: MIT
#include "CharacterFiles.h"

#include <filesystem>
#include <fstream>

namespace test {
namespace {

constexpr char kNeutral[] = "makehuman/body/body4k_neutral.obj";
constexpr char kMale[] = "makehuman/body/body4k_male.obj";
constexpr char kNeutralRig[] = "makehuman/rig/cmu_mb_neutral.bvh";
constexpr char kMaleRig[] = "makehuman/rig/cmu_mb_male.bvh";
constexpr char kPitch[] = "cmu/mb/124_01_pitch_excerpt_120hz.bvh";
constexpr char kWalk[] = "cmu/mb/12_01_walk_pybvh.bvh";

std::string shared(const char* file) {
    return std::string(OSGSKIN_SHARED_DATA) + "/" + file;
}

} // namespace

const std::vector<CharacterCase>& characterCases() {
    static const std::vector<CharacterCase> cases = {
        {"thrower", nullptr, nullptr, nullptr, "0:280:7", 0},
        {"neutral_pitch", kNeutral, kNeutralRig, kPitch, "0:27", 1},
        {"neutral_walk", kNeutral, kNeutralRig, kWalk, "0:519:10", 1},
        {"male_pitch", kMale, kMaleRig, kPitch, "0:27", 1},
        {"male_walk", kMale, kMaleRig, kWalk, "0:519:10", 1},
        {"thrower_shaped", nullptr, nullptr, nullptr, "0:280:7", 0, "fast"},
        {"thrower_muscles", nullptr, nullptr, nullptr, "0:280:7", 0, "fast",
         "on --tense LeftBiceps=0.7 --tense RightCalf=1"},
        {"male_walk_shaped", kMale, kMaleRig, kWalk, "0:519:10", 1, "fast"},
    };
    return cases;
}

bool isAvailable(const CharacterCase& c, std::string& why) {
    if (!c.mesh) return true;
    for (const char* file : {c.mesh, c.skeleton, c.motion})
        if (!std::filesystem::exists(shared(file))) {
            why = "third-party data is not here: " + shared(file);
            return false;
        }
    return true;
}

std::string skinFile(const CharacterCase& c, const std::string& folder) {
    if (!c.mesh) return OSGSKIN_DATA "/thrower.skin";
    std::string file = folder + "/character.skin";
    std::ofstream(file) << "{ \"osgskin\": 1, \"mesh\": \"" << shared(c.mesh)
                        << "\", \"skeleton\": \"" << shared(c.skeleton)
                        << "\", \"motions\": [ { \"file\": \"" << shared(c.motion)
                        << "\", \"name\": \"motion\", \"skipFrames\": " << c.skipFrames << " } ] }";
    return file;
}

std::ostream& operator<<(std::ostream& out, const CharacterCase& c) {
    return out << c.name;
}

} // namespace test
