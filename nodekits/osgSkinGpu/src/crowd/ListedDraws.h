// SPDX-License-Identifier: MIT
#pragma once

#include "crowd/CrowdDraws.h"
#include "crowd/CrowdMembers.h"
#include "crowd/CrowdView.h"

#include <memory>
#include <mutex>
#include <vector>

namespace osgSkin {

/// Draws of a crowd whose lists the processor fills: one for each place that a camera sees the
/// crowd at, as long as it is to be drawn there.
class ListedDraws {
public:
    /// \param character outlives this, as members do
    ListedDraws(const CrowdCharacter& character, const CrowdMembers& members);

    /// Lists who is seen, and adds the draws to a cull; any thread, several at once.
    void cull(osgUtil::CullVisitor& cv);

    /// How many there are; no more than draws were pending at once.
    std::size_t count() const { return _all.size(); }

    void resizeGLObjectBuffers(unsigned int maxSize);
    void releaseGLObjects(osg::State* state) const;

private:
    struct Listed {
        CrowdDraws draws;
        bool isTaken; ///< by a cull that has not added all of them yet
    };
    Listed& take();
    void list(const CrowdView& view, CrowdDraws& draws) const;

    const CrowdCharacter& _character;
    const CrowdMembers& _members;
    std::mutex _mutex;
    std::vector<std::unique_ptr<Listed>> _all;
};

} // namespace osgSkin
