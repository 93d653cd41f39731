// SPDX-License-Identifier: MIT
#include "BvhWriter.h"

#include <cmath>
#include <cstdio>
#include <istream>
#include <ostream>
#include <sstream>
#include <stdexcept>

namespace mannequin {
namespace {

/// Formats a number in any locale, never as "-0.000000".
std::string number(double value, int decimals = 6) {
    const double unit = std::pow(10, decimals);
    const double rounded = std::round(value * unit) / unit;
    char text[40];
    std::snprintf(text, sizeof text, "%.*f", decimals, rounded == 0 ? 0.0 : rounded);
    return text;
}

std::string offset(const glm::dvec3& v) {
    return "OFFSET " + number(v.x) + " " + number(v.y) + " " + number(v.z) + "\n";
}

enum class Root { Fixed, Moving };

void writeJoint(std::ostream& out, const Skeleton& skeleton, std::size_t i, Root root, int depth) {
    const std::vector<RestJoint>& joints = skeleton.joints();
    const RestJoint& joint = joints[i];
    const std::string outer(static_cast<std::size_t>(depth), '\t');
    const std::string inner = outer + '\t';
    const bool isRoot = joint.parent < 0;
    out << outer << (isRoot ? "ROOT " : "JOINT ") << joint.name << "\n" << outer << "{\n";
    glm::dvec3 place = joint.centre;
    if (!isRoot) place -= joints[static_cast<std::size_t>(joint.parent)].centre;
    if (isRoot && root == Root::Moving) place = glm::dvec3(0);
    out << inner << offset(place) << inner;
    if (isRoot && root == Root::Moving)
        out << "CHANNELS 6 Xposition Yposition Zposition Zrotation Yrotation Xrotation\n";
    else
        out << "CHANNELS 3 Zrotation Yrotation Xrotation\n";
    for (std::size_t child = i + 1; child < joints.size(); ++child)
        if (joints[child].parent == static_cast<int>(i))
            writeJoint(out, skeleton, child, root, depth + 1);
    if (joint.leaf)
        out << inner << "End Site\n"
            << inner << "{\n"
            << inner << '\t' << offset(joint.endSite - joint.centre) << inner << "}\n";
    out << outer << "}\n";
}

void writeRows(std::ostream& out, const std::vector<BvhRow>& rows,
               const MotionFormat& format = {}) {
    char step[40];
    std::snprintf(step, sizeof step, "%.9f", 1.0 / format.frameRate);
    out << "MOTION\nFrames: " << rows.size() << "\nFrame Time: " << step << "\n";
    for (const BvhRow& row : rows)
        for (std::size_t i = 0; i < row.size(); ++i)
            out << number(row[i], format.decimals) << (i + 1 < row.size() ? " " : "\n");
}

} // namespace

void writeRig(std::ostream& out, const Skeleton& skeleton) {
    out << "HIERARCHY\n";
    writeJoint(out, skeleton, 0, Root::Fixed, 0);
    writeRows(out, {BvhRow(3 * skeleton.joints().size(), 0.0)});
}

void writeMotion(std::ostream& out, const Skeleton& skeleton, const std::vector<BvhRow>& rows,
                 const MotionFormat& format) {
    out << "HIERARCHY\n";
    writeJoint(out, skeleton, 0, Root::Moving, 0);
    writeRows(out, rows, format);
}

void writeBall(std::ostream& out, const std::vector<BvhRow>& rows) {
    out << "HIERARCHY\nROOT ball\n{\n\tOFFSET 0.000000 0.000000 0.000000\n"
           "\tCHANNELS 6 Xposition Yposition Zposition Zrotation Yrotation Xrotation\n"
           "\tEnd Site\n\t{\n\t\tOFFSET 0.000000 0.037000 0.000000\n\t}\n}\n";
    writeRows(out, rows);
}

std::vector<BvhRow> readRows(std::istream& in) {
    std::string line;
    while (std::getline(in, line) && line.rfind("Frame Time:", 0) != 0) {
    }
    if (!in) throw std::runtime_error("a BVH file without a MOTION section");
    std::vector<BvhRow> rows;
    while (std::getline(in, line)) {
        std::istringstream numbers(line);
        BvhRow row;
        double value = 0;
        while (numbers >> value) row.push_back(value);
        if (!rows.empty() && row.size() != rows.front().size())
            throw std::runtime_error("a BVH frame of another length than the first");
        rows.push_back(row);
    }
    return rows;
}

} // namespace mannequin
