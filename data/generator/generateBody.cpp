// SPDX-License-Identifier: GPL-3.0-or-later
#include "Anthropometry.h"
#include "BareBody.h"
#include "DetailMap.h"
#include "IcoSphere.h"
#include "Isosurface.h"
#include "MeshReport.h"
#include "ObjWriter.h"
#include "Remesher.h"

#include <cmath>
#include <exception>
#include <fstream>
#include <iostream>
#include <stdexcept>
#include <string>

using namespace mannequin;

namespace {

constexpr double kGridSpacing = 0.005;   // metres; the gaps between the fingers are wider
constexpr double kTargetVertices = 4400; // 3,500 to 4,500 are allowed
constexpr int kCorrections = 6;
// A missing fingertip or ear exceeds the deviation.
constexpr MeshBounds kBounds{3500, 4500, 15, 0.009};
constexpr double kBallRadius = 0.037; // metres; a baseball

/// Remeshes `mesh`, a fine triangulation of the body's skin, to the target number of vertices.
void reduce(const ImplicitBody& body, SkinMesh& mesh) {
    const DetailMap detail = bareDetail();
    Remesher remesher(body, detail, mesh);
    double scale = std::sqrt(remesher.expectedVertices(1) / kTargetVertices);
    remesher.run(scale, 6);
    for (int i = 0; i < kCorrections; ++i) { // corrects the rough estimate by the result
        scale *= std::sqrt(static_cast<double>(mesh.number_of_vertices()) / kTargetVertices);
        remesher.run(scale, 4);
    }
    remesher.polish(20);
}

void save(const SkinMesh& mesh, const std::string& directory, const std::string& name) {
    const std::string path = directory + '/' + name + ".obj";
    std::ofstream out(path);
    writeObj(out, mesh, name);
    out.close();
    if (!out) throw std::runtime_error("cannot write " + path);
}

int generate(const std::string& directory, bool check) {
    const BareBody body;
    const SkinMesh model = isosurface(body, kGridSpacing);
    SkinMesh skin = model;
    reduce(body, skin);
    save(skin, directory, "thrower");
    save(icoSphere(kBallRadius), directory, "ball");
    const MeshReport report = inspect(skin, model);
    std::cout << report;
    printMeasures(std::cout, measureBody(skin));
    return check && !report.good(kBounds) ? 1 : 0;
}

} // namespace

int main(int argc, char** argv) {
    const bool check = argc == 3 && std::string(argv[1]) == "--check";
    if (argc != (check ? 3 : 2) || argv[argc - 1][0] == '-' || argv[argc - 1][0] == '\0') {
        std::cerr << "usage: osgskin_generate_body [--check] OUTDIR\n"
                     "Writes OUTDIR/thrower.obj and OUTDIR/ball.obj.\n"
                     "--check  fail unless the skin is what a deformable one must be\n";
        return 2;
    }
    try {
        return generate(argv[argc - 1], check);
    } catch (const std::exception& error) {
        std::cerr << error.what() << '\n';
        return 1;
    }
}
