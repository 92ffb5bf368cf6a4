/* Heights and parameters of a .gwy file as Gwyddion's own library has them. usage: gwyddion_params FILE.gwy HEIGHTS.f64
 * Prints one JSON object; HEIGHTS gets the heights row by row, in the file's unit, NaN where its mask is set. */
#include <glib.h>
#include <libgwyddion/gwyddion.h>
#include <libprocess/gwyprocess.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

static GwyContainer *read_file(const char *path) {
  gchar *bytes = NULL;
  gsize size = 0;
  gsize position = 4;
  if (!g_file_get_contents(path, &bytes, &size, NULL) || size < 4 || memcmp(bytes, "GWYP", 4) != 0) return NULL;
  return GWY_CONTAINER(gwy_serializable_deserialize((guchar *)bytes, size, &position));
}

static int write_heights(const char *path, GwyDataField *field, GwyDataField *mask) {
  const gdouble *heights = gwy_data_field_get_data_const(field);
  const gdouble *bad = mask ? gwy_data_field_get_data_const(mask) : NULL;
  const int count = gwy_data_field_get_xres(field) * gwy_data_field_get_yres(field);
  FILE *file = fopen(path, "wb");
  int good = file != NULL;
  for (int i = 0; good && i < count; ++i) {
    const double height = bad && bad[i] > 0.5 ? NAN : heights[i];
    good = fwrite(&height, sizeof height, 1, file) == 1;
  }
  return file && fclose(file) == 0 && good;
}

int main(int argc, char **argv) {
  GwyContainer *container;
  GwyDataField *field = NULL;
  GwyDataField *mask = NULL;
  gchar *xy_unit;
  gchar *z_unit;
  gdouble mean, sa, sq, ssk, excess, lowest, highest;
  if (argc != 3) return 64;
  gwy_type_init();
  gwy_process_type_init();
  container = read_file(argv[1]);
  if (!container || !gwy_container_gis_object_by_name(container, "/0/data", &field)) return 65;
  gwy_container_gis_object_by_name(container, "/0/mask", &mask);
  const int width = gwy_data_field_get_xres(field);
  const int height = gwy_data_field_get_yres(field);
  gwy_data_field_area_get_stats_mask(field, mask, GWY_MASK_EXCLUDE, 0, 0, width, height, &mean, &sa, &sq, &ssk, &excess);
  gwy_data_field_area_get_min_max_mask(field, mask, GWY_MASK_EXCLUDE, 0, 0, width, height, &lowest, &highest);
  xy_unit = gwy_si_unit_get_string(gwy_data_field_get_si_unit_xy(field), GWY_SI_UNIT_FORMAT_PLAIN);
  z_unit = gwy_si_unit_get_string(gwy_data_field_get_si_unit_z(field), GWY_SI_UNIT_FORMAT_PLAIN);
  printf("{\"width\": %d, \"height\": %d, \"x_real\": %.17g, \"y_real\": %.17g, \"xy_unit\": \"%s\", \"z_unit\": \"%s\", "
         "\"Sa\": %.17g, \"Sq\": %.17g, \"Ssk\": %.17g, \"Sku_less_3\": %.17g, \"Sz\": %.17g}\n",
         width, height, gwy_data_field_get_xreal(field), gwy_data_field_get_yreal(field), xy_unit, z_unit, sa, sq, ssk,
         excess, highest - lowest);
  return write_heights(argv[2], field, mask) ? 0 : 74;
}
