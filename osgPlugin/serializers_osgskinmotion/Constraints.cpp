// SPDX-License-Identifier: MIT
// Callbacks have virtual bases, for which the wrapper's default cast does not compile.
#undef OBJECT_CAST
#define OBJECT_CAST dynamic_cast

#include "Archive.h"
#include "FileVersion.h"
#include "RegisterWrapper.h"

#include <osgSkinMotion/Constraints>

#include <utility>
#include <vector>

namespace osgSkinMotion {
using osgSkin::Constraints; // osgDB knows classes by their libraries
} // namespace osgSkinMotion

namespace {

using osgSkin::Constraint;

struct ConstraintList {
    template <typename Archive>
    static void pass(Archive& archive, osgSkin::Constraints& constraints) {
        std::vector<Constraint> list = constraints.get();
        archive.list(list, "constraints", 59, [&](Constraint& each) {
            archive.choice(each.kind, 3, "a constraint");
            archive(each.axis, each.weight);
            for (Constraint::Joint* joint : {&each.joint, &each.source})
                archive(joint->name, joint->rest, joint->axes, joint->above);
        });
        if constexpr (Archive::kReads) constraints.set(std::move(list));
    }
};

} // namespace

REGISTER_OSGSKIN_WRAPPER(osgSkinMotion_Constraints, new osgSkin::Constraints,
                         osgSkinMotion::Constraints,
                         "osg::Object osg::Callback osg::NodeCallback osgSkinMotion::Constraints") {
    addFileVersion(*wrapper);
    addBlock<osgSkin::Constraints, ConstraintList>(*wrapper, "List", "constraints");
}
