// SPDX-License-Identifier: MIT
#include "crowd/TexelCheck.h"

#include "skin/ContextSupport.h"

#include <osg/Notify>
#include <osg/RenderInfo>

#include <atomic>

namespace osgSkin {

void TexelCheck::drawImplementation(osg::RenderInfo& renderInfo,
                                    const osg::Drawable* drawable) const {
    if (canReadTexels(renderInfo.getContextID(), _texels)) {
        _draw ? _draw->drawImplementation(renderInfo, drawable)
              : drawable->drawImplementation(renderInfo);
        return;
    }
    static std::atomic<bool> isTold{false};
    if (!isTold.exchange(true))
        OSG_WARN << "osgSkin: a crowd has a buffer of " << _texels
                 << " texels, more than this driver reads; nothing of it is drawn" << std::endl;
}

} // namespace osgSkin
