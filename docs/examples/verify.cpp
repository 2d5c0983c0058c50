// Whether a mesh keeps what somebody claims of it: nothing here trusts who made it.
#include <emax/certify.h>
#include <emax/check.h>

#include <cstdio>

int main() {
  // A unit square in two triangles, and in four around a middle point that is a little off.
  const emax::Surface reference = {{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}, {0, 1, 2, 0, 2, 3}};
  const emax::Surface mesh = {{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0.5, 0.5, 0.01},
                              {0, 1, 4, 1, 2, 4, 2, 3, 4, 3, 0, 4}};
  const std::vector<double> cloud = {0.1, 0.1, 0, 0.9, 0.2, 0.001, 0.5, 0.5, 0.002};

  for (const double claimed : {0.02, 0.009}) {
    const bool kept = emax::check_surface(mesh).valid() &&
                      emax::certify_points(cloud, mesh).upper <= claimed &&
                      emax::certify_within(mesh, reference, claimed) &&
                      emax::certify_within(reference, mesh, claimed);
    std::printf("within %g: %s\n", claimed, kept ? "proven" : "refuted");
  }
  const emax::CertifiedDistance apart = emax::certify_distance(mesh, reference);
  std::printf("the mesh strays by %.6f, at (%g, %g, %g)\n", apart.upper, apart.witness[0],
              apart.witness[1], apart.witness[2]);
}
