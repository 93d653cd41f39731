// SPDX-License-Identifier: MIT
#include "serialize/SkinModelBlock.h"

#include "model/CorrectiveBlocks.h"
#include "model/GradientBlocks.h"
#include "model/SkinBlocks.h"
#include "serialize/BlockWords.h"
#include "serialize/SharedObjects.h"

#include <osgSkin/Correctives>
#include <osgSkin/Error>
#include <osgSkin/ShareEqualData>

#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace osgSkin {
namespace {

// Flags of correctives.
constexpr std::uint32_t kNormals = 1, kInputs = 2;
// Parts that a model may lack.
constexpr std::uint32_t kGradients = 1, kCorrectives = 2;
// A flag of links.
constexpr std::uint32_t kPartial = 0x80000000u;

void putList(const std::vector<double>& numbers, BlockWriter& out) {
    out.put(numbers.size());
    for (const double number : numbers) out.put(number);
}

std::vector<double> takeList(BlockReader& in, const char* what) {
    std::vector<double> numbers(in.count(what, 2));
    for (double& number : numbers) number = in.longReal();
    return numbers;
}

CorrectiveJoint takeJoint(BlockReader& in) {
    CorrectiveJoint joint;
    joint.joint = in.word();
    joint.basis = static_cast<CorrectiveJoint::Basis>(in.word());
    joint.axis = in.longVector();
    for (glm::dvec2* range : {&joint.low, &joint.high}) {
        range->x = in.longReal();
        range->y = in.longReal();
    }
    joint.knots = takeList(in, "knots");
    joint.modes = in.word();
    joint.coefficients = takeList(in, "coefficients");
    joint.normalScales = takeList(in, "scales of normals");
    if (joint.modes > CorrectiveJoint::kMaxModes)
        in.fail("correctives have " + std::to_string(joint.modes) + " modes, expected " +
                std::to_string(CorrectiveJoint::kMaxModes) + " at most");
    return joint;
}

/// Flags, inputs and joints.
void putHead(const CorrectiveBlocks& correctives, BlockWriter& out) {
    out.put(std::uint32_t{(correctives.hasNormals ? kNormals : 0u) |
                          (correctives.inputs.empty() ? 0u : kInputs)});
    if (!correctives.inputs.empty()) out.put(correctives.inputs.size());
    for (const std::string& input : correctives.inputs) out.put(input);
    out.put(correctives.joints.size());
    for (const CorrectiveJoint& joint : correctives.joints) {
        out.put(joint.joint);
        out.put(static_cast<std::uint32_t>(joint.basis));
        out.putVector(joint.axis);
        for (const glm::dvec2& range : {joint.low, joint.high}) {
            out.put(range.x);
            out.put(range.y);
        }
        putList(joint.knots, out);
        out.put(joint.modes);
        putList(joint.coefficients, out);
        putList(joint.normalScales, out);
    }
}

/// Reads the same into correctives without entries.
/// \param[out] hasNormals what the flags say
Correctives takeHead(BlockReader& in, bool& hasNormals) {
    Correctives result;
    const std::uint32_t flags = in.word();
    if (flags & ~(kNormals | kInputs)) in.fail("its correctives have a flag that is not known");
    hasNormals = (flags & kNormals) != 0;
    const std::uint32_t inputs = flags & kInputs ? in.count("inputs", 1) : 0;
    for (std::uint32_t i = 0; i < inputs; ++i) result.inputs.push_back(in.text());
    const std::uint32_t joints = in.count("correctives' joints", 20);
    for (std::uint32_t j = 0; j < joints; ++j) result.joints.push_back(takeJoint(in));
    result.firstEntry.push_back(0);
    return result;
}

std::vector<glm::vec3> readVectors(BlockReader& in, std::uint32_t count) {
    std::vector<glm::vec3> vectors(count);
    in.copy(reinterpret_cast<float*>(vectors.data()), std::size_t{3} * count);
    return vectors;
}

BoundJoint readJoint(BlockReader& in) {
    BoundJoint joint;
    joint.parent = static_cast<int>(in.word());
    joint.name = in.text();
    joint.centre = in.longVector();
    joint.boneAxis = in.longVector();
    joint.twistAxis = in.longVector();
    return joint;
}

/// Writes the gradients.
void put(const GradientBlocks& gradients, BlockWriter& out) {
    out.put(gradients.unit);
    out.copy(gradients.across.data()->across, 3 * gradients.across.size());
    for (const GradientBlocks::Reach& reach : gradients.reach) {
        out.put(reach.bend);
        out.put(reach.twist);
    }
    for (const GradientRow& row : gradients.rows) out.shorts(row.lane, kBlock);
}

constexpr std::size_t kShortRow = kBlock / 2; // words of a row of 16-bit numbers

void takeGradients(BlockReader& in, SkinModel& model) {
    GradientBlocks from;
    std::size_t rows = 0, reaches = 0;
    for (const SkinModel::Group& group : model.groups()) {
        rows += (group.vertexCount + kBlock - 1) / kBlock *
                GradientBlocks::rowsPerBlock(group.partialCount);
        reaches += group.partialCount;
    }
    from.unit = in.longReal();
    from.across.resize(SkinModelAccess::blocks(model).firstBlock.back());
    in.copy(from.across.data()->across, 3 * from.across.size());
    for (std::size_t i = 0; i < reaches; ++i) {
        const float bend = in.real();
        from.reach.push_back({bend, in.real()});
    }
    in.expect(rows, kShortRow);
    from.rows.resize(rows);
    for (GradientRow& row : from.rows) in.shorts(row.lane, kBlock);
    SkinModelAccess::setGradients(model,
                                  std::make_shared<const GradientBlocks>(model, std::move(from)));
}

void put(const CorrectiveBlocks& correctives, BlockWriter& out) {
    putHead(correctives, out);
    for (std::size_t g = 0; g + 1 < correctives.firstRange.size(); ++g) {
        out.put(correctives.firstRange[g + 1] - correctives.firstRange[g]);
        for (std::uint32_t i = correctives.firstRange[g]; i < correctives.firstRange[g + 1]; ++i) {
            const CorrectiveBlocks::Range& range = correctives.ranges[i];
            out.put(range.joint);
            out.put(range.firstBlock);
            out.put(range.blockCount);
        }
    }
    for (const std::vector<CorrectiveRow>* rows : {&correctives.rows, &correctives.normalRows})
        for (const CorrectiveRow& row : *rows) out.shorts(row.lane, kBlock);
}

void takeCorrectives(BlockReader& in, SkinModel& model) {
    CorrectiveBlocks::Stored from{};
    Binding head; // to be checked, without vertices
    head.joints = model.joints();
    head.firstInfluence.push_back(0);
    head.correctives = takeHead(in, from.hasNormals);
    if (from.hasNormals) head.correctives.shares = head.correctives.normalShares = {0};
    head.validate();
    from.joints = std::move(head.correctives.joints);
    from.inputs = std::move(head.correctives.inputs);
    std::size_t rows = 0;
    from.firstRange.push_back(0);
    for (std::size_t g = 0; g < model.groups().size(); ++g) {
        const std::uint32_t count = in.count("correctives' ranges", 3);
        for (std::uint32_t i = 0; i < count; ++i) {
            CorrectiveBlocks::Range range{};
            range.joint = in.word();
            range.firstBlock = in.word();
            range.blockCount = in.word();
            if (range.joint >= from.joints.size())
                in.fail("correctives refer to a joint without modes");
            rows += std::size_t{range.blockCount} * 3 * from.joints[range.joint].modes;
            from.ranges.push_back(range);
        }
        from.firstRange.push_back(static_cast<std::uint32_t>(from.ranges.size()));
    }
    in.expect(rows, kShortRow * (from.hasNormals ? 2 : 1));
    from.rows.resize(rows);
    from.normalRows.resize(from.hasNormals ? rows : 0);
    for (std::vector<CorrectiveRow>* list : {&from.rows, &from.normalRows})
        for (CorrectiveRow& row : *list) in.shorts(row.lane, kBlock);
    SkinModelAccess::setCorrectives(
        model, std::make_shared<const CorrectiveBlocks>(model, std::move(from)));
}

osg::ref_ptr<const SkinModel> takeModel(BlockReader& in) {
    SkinModelAccess::Arranged from;
    Binding head; // to be checked, without vertices
    const std::uint32_t joints = in.count("joints", 20);
    for (std::uint32_t j = 0; j < joints; ++j) head.joints.push_back(readJoint(in));
    head.firstInfluence.push_back(0);
    head.validate();
    from.joints = std::move(head.joints);
    const std::uint32_t vertices = in.count("vertices", 7);
    if (vertices == 0) in.fail("it has no vertex");
    from.positions = readVectors(in, vertices);
    from.normals = readVectors(in, vertices);
    from.order.resize(vertices);
    in.copy(from.order.data(), vertices);
    from.groups.resize(in.count("groups", 3));
    for (SkinModel::Group& group : from.groups) {
        group.vertexCount = in.word();
        group.linkCount = in.count("links", 1);
        for (std::uint32_t i = 0; i < group.linkCount; ++i) {
            const std::uint32_t link = in.word();
            from.links.push_back({link & ~kPartial, (link & kPartial) != 0});
        }
    }
    from.ratios.resize(in.count("ratios", 2));
    in.copy(&from.ratios.data()->bend, 2 * from.ratios.size());
    const osg::ref_ptr<SkinModel> model = SkinModelAccess::make(std::move(from));
    const std::uint32_t parts = in.word();
    if (parts & ~(kGradients | kCorrectives)) in.fail("it has an unknown section");
    if (parts & kGradients) takeGradients(in, *model);
    if (parts & kCorrectives) takeCorrectives(in, *model);
    SkinModelAccess::addJointBoxes(*model);
    return model;
}

ContentHash hashOf(const std::vector<std::uint32_t>& words) {
    ContentHash hash;
    hash.add(words.data(), words.size() * sizeof(std::uint32_t));
    return hash;
}

/// Has the process share a model by the block that it was read from.
osg::ref_ptr<const SkinModel> share(const ContentHash& block,
                                    const osg::ref_ptr<const SkinModel>& model) {
    // Nobody changes it: the table's type alone is not const.
    return SharedObjects<SkinModel>::instance().add(block, const_cast<SkinModel*>(model.get()),
                                                    [](const SkinModel&) { return true; });
}

} // namespace

std::vector<std::uint32_t> packSkinModel(const SkinModel& model) {
    BlockWriter out;
    out.put(model.joints().size());
    for (const BoundJoint& joint : model.joints()) {
        out.put(static_cast<std::uint32_t>(joint.parent));
        out.put(joint.name);
        out.putVector(joint.centre);
        out.putVector(joint.boneAxis);
        out.putVector(joint.twistAxis);
    }
    out.put(model.vertexCount());
    for (const std::vector<glm::vec3>* vectors : {&model.positions(), &model.normals()})
        out.copy(&vectors->data()->x, 3 * vectors->size());
    out.copy(model.order().data(), model.order().size());
    out.put(model.groups().size());
    for (const SkinModel::Group& group : model.groups()) {
        out.put(group.vertexCount);
        out.put(group.linkCount);
        for (std::uint32_t i = 0; i < group.linkCount; ++i) {
            const SkinModel::Link& link = model.links()[group.firstLink + i];
            out.put(link.joint | (link.partial ? kPartial : 0u));
        }
    }
    out.put(model.ratios().size());
    out.copy(&model.ratios().data()->bend, 2 * model.ratios().size());
    const GradientBlocks* const gradients = SkinModelAccess::gradients(model);
    const CorrectiveBlocks* const correctives = SkinModelAccess::correctives(model);
    out.put((gradients ? kGradients : 0u) | (correctives ? kCorrectives : 0u));
    if (gradients) put(*gradients, out);
    if (correctives) put(*correctives, out);
    return out.words;
}

osg::ref_ptr<const SkinModel> unpackSkinModel(const std::vector<std::uint32_t>& words) {
    const ContentHash block = hashOf(words);
    if (osg::ref_ptr<const SkinModel> known = SharedObjects<SkinModel>::instance().find(block))
        return known;
    BlockReader in(words, "skin model block");
    const osg::ref_ptr<const SkinModel> model = takeModel(in);
    if (!in.atEnd()) in.fail("there is more in it than a model");
    return share(block, model);
}

void unpackSkinModel(const std::vector<std::uint32_t>& words, SkinModel& empty) {
    if (empty.vertexCount() > 0)
        throw Error("skin model block: the model to be filled is not empty");
    SkinModelAccess::fill(empty, *unpackSkinModel(words));
}

osg::ref_ptr<const SkinModel> shareEqualModel(const osg::ref_ptr<const SkinModel>& model) {
    if (!model->getName().empty() || model->getUserDataContainer()) return model;
    return share(hashOf(packSkinModel(*model)), model);
}

osg::ref_ptr<const SkinModel> unpackedModel(const osg::ref_ptr<const SkinModel>& read) {
    if (!read || !read->getName().empty() || read->getUserDataContainer()) return read;
    const SkinModel* const original = SkinModelAccess::original(*read);
    return original ? original : read.get();
}

} // namespace osgSkin
