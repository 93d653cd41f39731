// SPDX-License-Identifier: MIT
#include <osgSkinGpu/GpuSkin>

#include "skin/ComputeDrawer.h"
#include "skin/SharedBarrier.h"

#include <osg/NodeVisitor>

namespace osgSkin {
namespace {

class SwitchSkins : public osg::NodeVisitor {
public:
    explicit SwitchSkins(bool on) : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN), _on(on) {
        setNodeMaskOverride(~0u); // skins that are switched off may be switched on later
    }
    void apply(osg::Drawable& drawable) override {
        auto* skin = dynamic_cast<DeformableSkin*>(&drawable);
        if (!skin) return;
        setGpu(*skin, _on);
        ++count;
    }

    unsigned int count = 0;

private:
    bool _on;
};

} // namespace

void setGpu(DeformableSkin& skin, bool on) {
    const bool isOn = dynamic_cast<ComputeDrawer*>(skin.getDrawer()) != nullptr;
    if (on != isOn) skin.setDrawer(on ? new ComputeDrawer : nullptr);
}

unsigned int setGpu(osg::Node& scene, bool on) {
    SwitchSkins visitor(on);
    scene.accept(visitor);
    return visitor.count;
}

GpuCounts gpuCounts() {
    return {SkinDispatch::count(), SharedBarrier::instance().count()};
}

} // namespace osgSkin
