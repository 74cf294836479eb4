/* Steady turbulent flow by Code_Saturne: what cs_solver asks its user for. saturne_flow.py writes flow.h,
   which has the numbers of the flow, and loads this before the solver's own library, whose empty functions of
   the same names then give way. */
#include "bft_mem.h"
#include "cs_defs.h"
#include "cs_domain.h"
#include "cs_field.h"
#include "cs_field_pointer.h"
#include "cs_log.h"
#include "cs_math.h"
#include "cs_mesh.h"
#include "cs_mesh_quantities.h"
#include "cs_parall.h"
#include "cs_parameters.h"
#include "cs_physical_constants.h"
#include "cs_prototypes.h"
#include "cs_selector.h"
#include "cs_stokes_model.h"
#include "cs_time_step.h"
#include "cs_turbulence_model.h"
#include "flow.h"

#include <math.h>
#include <stdio.h>

/* What is written of boundary faces; the first: forces. */
extern int __entsor_MOD_ipstdv[];

static const cs_real_t velocity[3] = VELOCITY;

/* Does `body` for each boundary face of a group, which need not exist. */
#define FOR_FACES_OF(group, face, body)                   \
  do {                                                    \
    cs_lnum_t n, *list;                                   \
    BFT_MALLOC(list, cs_glob_mesh->n_b_faces, cs_lnum_t); \
    cs_selector_get_b_face_list(group, &n, list);         \
    for (cs_lnum_t i = 0; i < n; i++) {                   \
      const cs_lnum_t face = list[i];                     \
      body                                                \
    }                                                     \
    BFT_FREE(list);                                       \
  } while (0)

void cs_user_model(void) {
  cs_get_glob_turb_model()->iturb = CS_TURB_K_OMEGA;
}

static void change_options(cs_field_t* field, cs_real_t upwind) {
  const int key = cs_field_key_id("var_cal_opt");
  cs_var_cal_opt_t options;
  cs_field_get_key_struct(field, key, &options);
  options.epsilo = 1e-5;                       /* 1e-8 by default; 1e-3 leaves pressure as it was */
  if (field == CS_F_(p)) options.relaxv = 0.3; /* 1 less that of the others by default */
  if (field != CS_F_(p)) {
    options.imligr =
        1; /* gradients limited by those of neighbours: without, second order dies within ten iterations */
    options.climgr = 1; /* that of pressure is not: lift would be 16 instead of 3 % above that of OpenFOAM
                           about an ONERA M6 */
  }
  options.blencv = 1 - upwind;
  cs_field_set_key_struct(field, key, &options);
}

void cs_user_parameters(cs_domain_t* domain) {
  cs_time_step_options_t* options = cs_get_glob_time_step_options();
  options->idtvar = -1;   /* steady */
  options->relxst = 0.85; /* with 0.7, the default, lift about NACA 0012 is 7 % below that of OpenFOAM after
                             300 iterations, and still rises */
  domain->time_step->nt_max = ITERATIONS;
  cs_fluid_properties_t* fluid = cs_get_glob_fluid_properties();
  fluid->ro0 = 1;
  fluid->viscl0 = VISCOSITY;
  cs_get_glob_turb_ref_values()->uref = cs_math_3_norm(velocity);
  __entsor_MOD_ipstdv[0] = 1;
  for (int f = 0; f < cs_field_n_fields(); f++) {
    if (cs_field_by_id(f)->type & CS_FIELD_VARIABLE) change_options(cs_field_by_id(f), 1);
  }
}

static cs_real_t square_distance_to_segment(const cs_real_t p[3], const cs_real_t a[3],
                                            const cs_real_t b[3]) {
  cs_real_t along[3], to[3];
  for (int k = 0; k < 3; k++) along[k] = b[k] - a[k], to[k] = p[k] - a[k];
  const cs_real_t t = CS_MIN(1, CS_MAX(0, cs_math_3_dot_product(along, to) / cs_math_3_square_norm(along)));
  for (int k = 0; k < 3; k++) to[k] -= t * along[k];
  return cs_math_3_square_norm(to);
}

static cs_real_t square_distance_to_triangle(const cs_real_t p[3], const cs_real_t* corners[3]) {
  cs_real_t sides[2][3], normal[3], to[3];
  for (int k = 0; k < 3; k++) {
    sides[0][k] = corners[1][k] - corners[0][k], sides[1][k] = corners[2][k] - corners[0][k],
    to[k] = p[k] - corners[0][k];
  }
  cs_math_3_cross_product(sides[0], sides[1], normal);
  int inside = 1;
  cs_real_t nearest = cs_math_infinite_r;
  for (int c = 0; c < 3; c++) {
    const cs_real_t *a = corners[c], *b = corners[(c + 1) % 3];
    const cs_real_t edge[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]},
                    from[3] = {p[0] - a[0], p[1] - a[1], p[2] - a[2]};
    cs_real_t inwards[3];
    cs_math_3_cross_product(normal, edge, inwards);
    if (cs_math_3_dot_product(inwards, from) < 0) inside = 0;
    nearest = CS_MIN(nearest, square_distance_to_segment(p, a, b));
  }
  if (!inside) return nearest;
  const cs_real_t height = cs_math_3_dot_product(normal, to);
  return height * height / cs_math_3_square_norm(normal);
}

/* Wall distances, those to the nearest triangle, on one process. The solver's own function solves an equation
   of Poisson, whose matrix has entries that differ by fifteen orders of magnitude on layers of y+ 1:
   conjugate gradients stop, multigrid ends at three times the size of the domain. */
void distpr_(const cs_int_t* bc_type, cs_real_t* not_passed) {
  CS_UNUSED(bc_type);
  CS_UNUSED(not_passed);
  cs_real_t* distances = cs_field_by_name("wall_distance")->val;
  const cs_mesh_t* mesh = cs_glob_mesh;
  const cs_real_3_t* cells = (const cs_real_3_t*)cs_glob_mesh_quantities->cell_cen;
  const cs_real_3_t* centres = (const cs_real_3_t*)cs_glob_mesh_quantities->b_face_cog;
  for (cs_lnum_t cell = 0; cell < mesh->n_cells; cell++) distances[cell] = cs_math_infinite_r;
  FOR_FACES_OF(WALL, face, {
    const cs_real_t* corners[3];
    cs_real_t radius = 0;
    for (int k = 0; k < 3; k++) {
      corners[k] = mesh->vtx_coord + 3 * mesh->b_face_vtx_lst[mesh->b_face_vtx_idx[face] + k];
      radius = CS_MAX(radius, cs_math_3_distance(corners[k], centres[face]));
    }
    for (cs_lnum_t cell = 0; cell < mesh->n_cells; cell++) {
      if (cs_math_3_distance(cells[cell], centres[face]) - radius > distances[cell]) continue;
      distances[cell] = CS_MIN(distances[cell], sqrt(square_distance_to_triangle(cells[cell], corners)));
    }
  });
}

static void set_value(const cs_field_t* field, int component, cs_lnum_t face, int icodcl[],
                      cs_real_t rcodcl[], cs_real_t value) {
  const int variable = cs_field_get_key_int(field, cs_field_key_id("variable_id")) - 1 + component;
  const cs_lnum_t at = variable * cs_glob_mesh->n_b_faces + face;
  icodcl[at] = 1;
  rcodcl[at] = value;
}

void cs_user_boundary_conditions(int nvar, int bc_type[], int icodcl[], cs_real_t rcodcl[]) {
  CS_UNUSED(nvar);
  const cs_real_3_t* normals = (const cs_real_3_t*)cs_glob_mesh_quantities->b_face_normal;
  FOR_FACES_OF(WALL, face, bc_type[face] = CS_SMOOTHWALL;);
  FOR_FACES_OF(SYMMETRY, face, bc_type[face] = CS_SYMMETRY;);
  FOR_FACES_OF(FARFIELD, face, {
    if (cs_math_3_dot_product(velocity, normals[face]) > 0) {
      bc_type[face] = CS_OUTLET;
      continue;
    }
    bc_type[face] = CS_INLET;
    for (int k = 0; k < 3; k++) set_value(CS_F_(vel), k, face, icodcl, rcodcl, velocity[k]);
    set_value(CS_F_(k), 0, face, icodcl, rcodcl, K);
    set_value(CS_F_(omg), 0, face, icodcl, rcodcl, OMEGA);
  });
}

void cs_user_initialization(cs_domain_t* domain) {
  for (cs_lnum_t cell = 0; cell < domain->mesh->n_cells; cell++) {
    for (int k = 0; k < 3; k++) CS_F_(vel)->val[3 * cell + k] = velocity[k];
    CS_F_(k)->val[cell] = K;
    CS_F_(omg)->val[cell] = OMEGA;
  }
}

/* That in Fortran, called too, which stops the run where nobody has written it. */
void cs_f_user_boundary_conditions_(void) {}

/* A line of forces.csv: the iteration, the force of the fluid on the wall, the largest speed. */
void cs_user_extra_operations(cs_domain_t* domain) {
  if (domain->time_step->nt_cur == FIRST_ORDER) change_options(CS_F_(vel), 0);
  const cs_field_t* forces = cs_field_by_name("boundary_forces");
  cs_real_t sum[3] = {0, 0, 0}, fastest = 0;
  FOR_FACES_OF(WALL, face, for (int k = 0; k < 3; k++) sum[k] += forces->val[3 * face + k];);
  for (cs_lnum_t cell = 0; cell < domain->mesh->n_cells; cell++) {
    fastest = CS_MAX(fastest, cs_math_3_norm(CS_F_(vel)->val + 3 * cell));
  }
  cs_parall_sum(3, CS_REAL_TYPE, sum);
  cs_parall_max(1, CS_REAL_TYPE, &fastest);
  if (cs_glob_rank_id > 0) return;
  FILE* file = fopen("forces.csv", "a");
  if (file == NULL) return;
  fprintf(file, "%d,%.9g,%.9g,%.9g,%.9g\n", domain->time_step->nt_cur, sum[0], sum[1], sum[2], fastest);
  fclose(file);
}
