// SPDX-License-Identifier: GPL-3.0-or-later

// osgskin_generate_pedestrian OUTDIR [--check]
//
// Writes a clothed figure (pedestrian.obj, pedestrian.mtl), its rig (pedestrian.bvh) and its
// motions (pedestrian_idle.bvh, ..._walk.bvh, ..._run.bvh, ..._wave.bvh), and prints a report. With
// --check it reads the motions back and exits with 1 if the figure or a motion is not what it must
// be.
//
// osgskin_generate_pedestrian OUTDIR --seed N
//
// Makes a person of the pedestrian.obj that is in OUTDIR, see People.h.

#include "BvhWriter.h"
#include "Isosurface.h"
#include "MeshReport.h"
#include "PaintedMesh.h"
#include "PedestrianMotions.h"
#include "People.h"
#include "Remesher.h"

#include <cmath>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iostream>
#include <stdexcept>
#include <string>

namespace {

using namespace mannequin;

constexpr double kGridSpacing = 0.008;   // metres
constexpr double kTargetVertices = 1750; // before edges are tucked in
constexpr int kCorrections = 6;
constexpr MeshBounds kBounds{1300, 2000, 3, 0.020};
constexpr std::uintmax_t kMostBytes = 450000; // of all files

void writeFile(const std::string& path, const std::function<void(std::ostream&)>& write) {
    std::ofstream out(path, std::ios::binary);
    write(out);
    out.close();
    if (!out) throw std::runtime_error("cannot write " + path);
}

PaintedMesh clothed(const PedestrianBody& body, SkinMesh mesh) {
    const DetailMap detail = pedestrianDetail();
    Remesher remesher(body, detail, mesh);
    double scale = std::sqrt(remesher.expectedVertices(1) / kTargetVertices);
    remesher.run(scale, 6);
    for (int i = 0; i < kCorrections; ++i) {
        scale *= std::sqrt(static_cast<double>(mesh.number_of_vertices()) / kTargetVertices);
        remesher.run(scale, 4);
    }
    for (const MaterialEdge& edge : materialEdges()) remesher.follow({edge.side, edge.applies});
    remesher.polish(20);
    PaintedMesh result = painted(mesh, body);
    for (const Tuck& edge : tucks()) tuck(result, edge, body);
    return result;
}

int run(const std::string& folder, bool check) {
    const PedestrianBody body;
    const SkinMesh model = isosurface(body, kGridSpacing);
    const PaintedMesh mesh = clothed(body, model);
    writeFile(folder + "/pedestrian.obj",
              [&](std::ostream& out) { writePaintedObj(out, mesh, "pedestrian"); });
    writeFile(folder + "/pedestrian.mtl", writeMaterials);
    const MeshReport report = inspect(unpainted(mesh), model);
    std::cout << report;

    const Skeleton skeleton;
    writeFile(folder + "/pedestrian.bvh", [&](std::ostream& out) { writeRig(out, skeleton); });
    bool good = report.good(kBounds);
    for (const PedestrianMotion& motion : pedestrianMotions(skeleton)) {
        const std::string path = folder + "/pedestrian_" + motion.name + ".bvh";
        writeFile(path, [&](std::ostream& out) {
            writeMotion(out, skeleton, motion.rows(), {motion.frameRate, 5});
        });
        std::ifstream in(path, std::ios::binary);
        good = checkMotion(std::cout, skeleton, motion, readRows(in)) && good;
    }
    std::uintmax_t bytes = 0;
    for (const auto& file : std::filesystem::directory_iterator(folder))
        if (file.path().filename().string().rfind("pedestrian", 0) == 0) bytes += file.file_size();
    std::cout << bytes << " bytes, at most " << kMostBytes << '\n';
    return check && !(good && bytes <= kMostBytes) ? 1 : 0;
}

} // namespace

int main(int argc, char** argv) {
    const std::string option = argc >= 3 ? argv[2] : "";
    const bool isPerson = argc == 4 && option == "--seed" && argv[3][0] != '\0' &&
                          std::string(argv[3]).size() < 7 &&
                          std::string(argv[3]).find_first_not_of("0123456789") == std::string::npos;
    if (argc < 2 || argv[1][0] == '-' || argv[1][0] == '\0' ||
        (argc > 2 && !isPerson && !(argc == 3 && option == "--check"))) {
        std::cerr << "usage: osgskin_generate_pedestrian OUTDIR [--check | --seed N]\n";
        return 2;
    }
    try {
        if (isPerson) {
            writePerson(argv[1], static_cast<unsigned int>(std::stoul(argv[3])));
            return 0;
        }
        return run(argv[1], option == "--check");
    } catch (const std::exception& error) {
        std::cerr << "osgskin_generate_pedestrian: " << error.what() << "\n";
        return 2;
    }
}
