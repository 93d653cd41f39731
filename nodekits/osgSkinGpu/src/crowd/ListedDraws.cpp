// SPDX-License-Identifier: MIT
#include "crowd/ListedDraws.h"

namespace osgSkin {

ListedDraws::ListedDraws(const CrowdCharacter& character, const CrowdMembers& members)
    : _character(character), _members(members) {}

void ListedDraws::cull(osgUtil::CullVisitor& cv) {
    Listed& listed = take();
    list(CrowdView(*cv.getModelViewMatrix(), *cv.getProjectionMatrix()), listed.draws);
    listed.draws.setBound(_members.box());
    listed.draws.cull(cv);
    const std::lock_guard<std::mutex> lock(_mutex);
    listed.isTaken = false;
}

ListedDraws::Listed& ListedDraws::take() {
    const std::lock_guard<std::mutex> lock(_mutex);
    for (const std::unique_ptr<Listed>& old : _all)
        if (!old->isTaken && old->draws.isFree()) {
            old->isTaken = true;
            return *old;
        }
    _all.push_back(std::make_unique<Listed>(
        Listed{CrowdDraws(_character, _members.size(), CrowdDraws::Count::Direct), true}));
    return *_all.back();
}

void ListedDraws::list(const CrowdView& view, CrowdDraws& draws) const {
    const std::vector<osg::Vec4f>& spheres = _members.spheres();
    std::vector<std::size_t> counts(_character.levelCount(), 0);
    osg::UIntArray& places = draws.list();
    for (std::size_t i = 0; i < spheres.size(); ++i) {
        if (!view.sees(spheres[i])) continue;
        const std::size_t level = view.levelOf(spheres[i], _character.levelSizes());
        places[level * spheres.size() + counts[level]++] = static_cast<GLuint>(i);
    }
    places.dirty();
    for (std::size_t level = 0; level < counts.size(); ++level)
        draws.setCount(level, counts[level]);
}

void ListedDraws::resizeGLObjectBuffers(unsigned int maxSize) {
    for (const std::unique_ptr<Listed>& listed : _all) listed->draws.resizeGLObjectBuffers(maxSize);
}

void ListedDraws::releaseGLObjects(osg::State* state) const {
    for (const std::unique_ptr<Listed>& listed : _all) listed->draws.releaseGLObjects(state);
}

} // namespace osgSkin
