// SPDX-License-Identifier: MIT
#pragma once

#include "ToGltf.h"

#include <nlohmann/json.hpp>

#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace bake {

/// The VRM 1 extensions of a rigged file: springs of any character, and what a VRM file (0 or 1)
/// says of its figure.
class Vrm {
public:
    /// \param character must outlive this; its file is read again for what osgSkin does not keep
    explicit Vrm(const osgSkin::Character& character);

    /// Whether the file says which joint is which part of a human (VRMC_vrm).
    bool isHuman() const { return !_human.is_null(); }
    /// A sentence without the file's name: what was translated, or why isHuman() is false although
    /// the file is a VRM. Empty if there is nothing to say.
    const std::string& note() const { return _note; }
    /// Parts of the character's VRM file that are not written.
    const std::vector<std::string>& leftOut() const { return _leftOut; }
    /// Whether a morph target is an expression, whose name is not to be another target's.
    bool isExpression(const std::string& morph) const { return _expressions.count(morph) > 0; }

    /// Adds the extensions.
    /// \param morphs names of the mesh's targets, in their order
    /// \param meshNode of the mesh
    /// \param root a file whose first nodes are the joints; gets nodes for the ends of springs
    void write(const std::vector<std::string>& morphs, std::size_t meshNode,
               nlohmann::json& root) const;

private:
    /// An expression as VRM 1 has it, without its morph targets.
    struct Expression {
        bool isPreset = false;
        std::string name;
        nlohmann::json rules = nlohmann::json::object();
    };

    void readSecond(const nlohmann::json& vrm);
    void readFirst(const nlohmann::json& vrm);
    void addExpression(const nlohmann::json& from, const std::string& morph, Expression expression);
    void addBones(std::vector<std::string>& missing);
    /// Adds eyes and jaw, which are no roles, from the character's file.
    void addFaceBones(const nlohmann::json& bones, const nlohmann::json& nodes);
    nlohmann::json springs(nlohmann::json& root) const;

    const osgSkin::Character& _character;
    ToGltf _toGltf;
    nlohmann::json _human;                          ///< VRMC_vrm without expressions; null: none
    std::map<std::string, Expression> _expressions; ///< by morph target
    std::string _note;
    std::vector<std::string> _leftOut;
};

} // namespace bake
