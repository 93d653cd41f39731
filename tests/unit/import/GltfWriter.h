// SPDX-License-Identifier: MIT
#pragma once

#include "Figure.h"

#include <osgSkinRig/Motion>

#include <glm/gtc/quaternion.hpp>

#include <cstdint>
#include <cstring>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

/// A glTF file's single buffer, with its views and accessors.
class GltfBuffer {
public:
    /// Adds `count` elements of `width` numbers; returns the accessor's index.
    std::size_t add(const std::vector<float>& numbers, std::size_t width, bool isTime) {
        const std::size_t bytes = numbers.size() * sizeof(float), at = _bytes.size();
        _bytes.resize(at + bytes);
        std::memcpy(_bytes.data() + at, numbers.data(), bytes);
        _views << (_count ? "," : "") << "{\"buffer\":0,\"byteOffset\":" << at
               << ",\"byteLength\":" << bytes << "}";
        static const char* const kTypes[] = {"", "SCALAR", "", "VEC3", "VEC4"};
        _accessors << (_count ? "," : "") << "{\"bufferView\":" << _count
                   << ",\"componentType\":5126,\"count\":" << numbers.size() / width
                   << ",\"type\":\"" << kTypes[width] << "\"";
        if (isTime)
            _accessors << ",\"min\":[" << numbers.front() << "],\"max\":[" << numbers.back() << "]";
        _accessors << "}";
        return _count++;
    }

    std::string text() const {
        static const char* const kDigits =
            "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
        std::string data;
        for (std::size_t i = 0; i < _bytes.size(); i += 3) {
            std::uint32_t three = 0;
            for (std::size_t k = 0; k < 3; ++k)
                three = (three << 8u) | (i + k < _bytes.size() ? _bytes[i + k] : 0u);
            for (std::size_t k = 0; k < 4; ++k)
                data += i + k > _bytes.size() ? '=' : kDigits[(three >> (18 - 6 * k)) & 63u];
        }
        return "\"buffers\":[{\"byteLength\":" + std::to_string(_bytes.size()) +
               ",\"uri\":\"data:application/octet-stream;base64," + data +
               "\"}],\"bufferViews\":[" + _views.str() + "],\"accessors\":[" + _accessors.str() +
               "]";
    }

private:
    std::vector<std::uint8_t> _bytes;
    std::ostringstream _views, _accessors;
    std::size_t _count = 0;
};

/// Writes a motion as a glTF file with nodes and one animation, no mesh.
/// \param motion to write
/// \param axes from each joint's own axes to the motion's zero pose
/// \param posed rotations of the nodes relative to the zero pose
/// \param path of the file
inline void writeGltf(const osgSkin::Motion& motion, const std::vector<glm::dquat>& axes,
                      const std::vector<glm::dquat>& posed, const std::string& path) {
    const auto& joints = motion.skeleton.joints;
    const auto quaternion = [](const glm::dquat& q) {
        return std::vector<float>{float(q.x), float(q.y), float(q.z), float(q.w)};
    };
    const auto local = [&](std::size_t j, const std::vector<glm::dquat>& world) {
        const glm::dquat own = world[j] * axes[j];
        if (joints[j].parent < 0) return glm::normalize(own);
        const auto p = std::size_t(joints[j].parent);
        return glm::normalize(glm::conjugate(world[p] * axes[p]) * own);
    };
    std::ostringstream nodes, channels, samplers;
    GltfBuffer buffer;
    std::vector<float> times;
    std::vector<std::vector<glm::dquat>> worlds;
    std::vector<float> roots;
    for (std::size_t f = 0; f < motion.frames; ++f) {
        times.push_back(float(double(f) * motion.frameTime));
        worlds.push_back(place(motion, f).turns);
        for (int axis = 0; axis < 3; ++axis) roots.push_back(float(motion.rootPositions[f][axis]));
    }
    const std::size_t input = buffer.add(times, 1, true);
    for (std::size_t j = 0; j < joints.size(); ++j) {
        glm::dvec3 offset = joints[j].centre;
        if (joints[j].parent >= 0) {
            const auto p = std::size_t(joints[j].parent);
            offset = glm::conjugate(axes[p]) * (joints[j].centre - joints[p].centre);
        }
        const std::vector<float> rest = quaternion(local(j, posed));
        nodes << (j ? "," : "") << "{\"name\":\"" << joints[j].name << "\",\"translation\":["
              << offset.x << "," << offset.y << "," << offset.z << "],\"rotation\":[" << rest[0]
              << "," << rest[1] << "," << rest[2] << "," << rest[3] << "]";
        std::string children;
        for (const int child : motion.skeleton.children(int(j)))
            children += (children.empty() ? "" : ",") + std::to_string(child);
        if (!children.empty()) nodes << ",\"children\":[" << children << "]";
        nodes << "}";
        std::vector<float> turns;
        for (std::size_t f = 0; f < motion.frames; ++f)
            for (const float number : quaternion(local(j, worlds[f]))) turns.push_back(number);
        samplers << (j ? "," : "") << "{\"input\":" << input
                 << ",\"output\":" << buffer.add(turns, 4, false) << "}";
        channels << (j ? "," : "") << "{\"sampler\":" << j << ",\"target\":{\"node\":" << j
                 << ",\"path\":\"rotation\"}}";
    }
    samplers << ",{\"input\":" << input << ",\"output\":" << buffer.add(roots, 3, false) << "}";
    channels << ",{\"sampler\":" << joints.size()
             << ",\"target\":{\"node\":0,\"path\":\"translation\"}}";
    std::ofstream(path) << "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]"
                           "}],\"nodes\":["
                        << nodes.str() << "],\"animations\":[{\"name\":\"move\",\"channels\":["
                        << channels.str() << "],\"samplers\":[" << samplers.str() << "]}],"
                        << buffer.text() << "}\n";
}
