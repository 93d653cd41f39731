// SPDX-License-Identifier: MIT
#ifndef OSGSKINCHARACTER_ARMS_BODYAVOIDER_H
#define OSGSKINCHARACTER_ARMS_BODYAVOIDER_H

#include "arms/ArmTurns.h"
#include "arms/SkinCuts.h"

#include <osgSkinCharacter/AvoidBody>

#include <optional>

namespace osgSkin {

/// avoidBody() for any number of clips of one body.
class BodyAvoider {
public:
    /// \param rest must outlive this
    /// \param roles as for avoidBody()
    /// \param mesh as for avoidBody()
    /// \param binding as for avoidBody()
    /// \throw osgSkin::Error where binding or roles do not fit
    BodyAvoider(const RestSkeleton& rest, const JointRoles& roles, const SkinMesh& mesh,
                const Binding& binding);

    /// \throw osgSkin::Error where the clip is not of the skeleton
    AvoidBodyReport apply(Clip& clip);

private:
    std::array<bool, 2> look(const PosedJoints& pose, ArmSample& sample);
    std::vector<ArmSample> sample(const Clip& clip, std::size_t stride, std::size_t window);
    bool widenMargins(const Clip& clip, std::size_t stride, const ArmTurns& turns,
                      std::vector<ArmSample>& samples);
    void turnArms(const ArmPair& vectors, std::size_t frame, Clip& clip,
                  AvoidBodyReport& report) const;

    const RestSkeleton& _rest;
    std::optional<BodyPieces> _pieces;
    std::optional<BodyFields> _fields; ///< unset where nothing is known of arms
    std::optional<SkinCuts> _cuts;
    /// Distances that a point may have at least: a bit less than at rest.
    std::array<std::array<std::vector<double>, BodyFields::kFields>, 2> _most;
};

} // namespace osgSkin

#endif
