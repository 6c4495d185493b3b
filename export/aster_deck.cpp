#include "export/deck_parts.hpp"
#include "export/text_output.hpp"
#include "preproc/mesh/file_extension.hpp"

#include <sstream>

namespace scan2fea {
namespace {

// Of Code_Aster, whose concepts, what is assigned here, have names of eight characters at most.
constexpr std::size_t longest_group = 24;

// Names come from files: no more of Python than what stands between quotes.
std::string quoted(const std::string& name) {
  std::string text = "\"";
  for (const char c : one_line(name)) {
    if (c == '"' || c == '\\') text += '\\';
    text += c;
  }
  return text + "\"";
}

bool reads_med(const DeckParts& parts) {
  return lower_case_extension(parts.mesh_file) == ".med";
}

void write_head(std::ostream& out, const DeckParts& parts) {
  const DeckUnits& units = parts.units;
  const bool modal = parts.kind == DeckKind::modal, med = reads_med(parts);
  const std::string mesh = one_line(parts.mesh_file);
  out << "# " << (modal ? "Natural frequencies" : "Static analysis") << " of " << mesh
      << ", for Code_Aster; made by scan2fea, to be edited\n"
      << "# unit of length: " << units.length << "\n"
      << "# Units: " << units.length << ", " << units.force << ", " << units.mass << ", s; so stresses are in "
      << units.stress << " and densities in " << units.of_density_text() << (modal ? ", frequencies in Hz" : "")
      << ".\n# What scan2fea cannot know stands below lines with ASSUMED.\n"
      << "# Files, as lines of the .export:\n"
      << (med ? "#   F mmed " : "#   F mail ") << mesh
      << " D 20\n#   F rmed results.rmed R 80\n#   F resu results.resu R 8\n"
      << "DEBUT(LANG=\"EN\")\n\n"
      << "mesh = LIRE_MAILLAGE(FORMAT=" << (med ? "\"MED\"" : "\"ASTER\"") << ", UNITE=20)\n";
  if (parts.fixed.of_faces)
    out << "# The nodes of the faces, where reactions are summed\n"
        << "mesh = DEFI_GROUP(reuse=mesh, MAILLAGE=mesh, CREA_GROUP_NO=_F(GROUP_MA=" << quoted(parts.fixed.name)
        << ", NOM=" << quoted(parts.fixed_nodes) << "))\n";
  out << "model = AFFE_MODELE(\n    MAILLAGE=mesh, AFFE=_F(TOUT=\"OUI\", PHENOMENE=\"MECANIQUE\", "
         "MODELISATION=\"3D\")\n)\n\n";
}

void write_material(std::ostream& out, const DeckParts& parts) {
  const DeckUnits& units = parts.units;
  out << "# ASSUMED: steel. Young's modulus (" << units.stress << "), Poisson's ratio, density ("
      << units.of_density_text() << ")\n"
      << "steel = DEFI_MATERIAU(\n    ELAS=_F(E=" << deck_number(units.of_stress(Steel::young))
      << ", NU=" << deck_number(Steel::poisson) << ", RHO=" << deck_number(units.of_density(Steel::density))
      << ")\n)\n";
  for (const std::string& name : parts.no_bodies) out << "# " << one_line(name) << " overlaps with a body\n";
  for (const std::string& name : parts.bodies)
    if (name.size() > longest_group) out << "# " << one_line(name) << ": a name longer than Code_Aster takes\n";
  if (!parts.bodies.empty()) out << "# ASSUMED: all bodies are of it. The first line is for elements of no body.\n";
  out << "material = AFFE_MATERIAU(\n    MAILLAGE=mesh,\n    AFFE=(\n        _F(TOUT=\"OUI\", MATER=steel),\n";
  for (const std::string& name : parts.bodies)
    if (name.size() <= longest_group) out << "        _F(GROUP_MA=" << quoted(name) << ", MATER=steel),\n";
  out << "    ),\n)\n\n";
}

void write_fixed(std::ostream& out, const DeckParts& parts) {
  out << "# ASSUMED: " << one_line(parts.fixed.name) << " does not move at all\n"
      << "clamp = AFFE_CHAR_MECA(\n    MODELE=model, DDL_IMPO=_F(" << (parts.fixed.of_faces ? "GROUP_MA=" : "GROUP_NO=")
      << quoted(parts.fixed.name) << ", DX=0.0, DY=0.0, DZ=0.0)\n)\n";
}

void write_static(std::ostream& out, const DeckParts& parts) {
  const DeckUnits& units = parts.units;
  const std::string nodes = quoted(parts.fixed.of_faces ? parts.fixed_nodes : parts.fixed.name);
  out << "# ASSUMED: a pressure of 1 MPa (" << deck_number(units.of_stress(deck_pressure)) << " " << units.stress
      << ") onto " << one_line(parts.loaded) << ". Below 0 it pulls.\n";
  for (const std::string& remark : load_remarks(parts)) out << "# " << remark << "\n";
  out << "load = AFFE_CHAR_MECA(MODELE=model, PRES_REP=_F(GROUP_MA=" << quoted(parts.loaded)
      << ", PRES=" << deck_number(units.of_stress(deck_pressure)) << "))\n"
      << "# Its weight, too, where the # is taken away here and in EXCIT\n"
      << "# weight = AFFE_CHAR_MECA(\n#     MODELE=model, PESANTEUR=_F(GRAVITE="
      << deck_number(units.of_acceleration(deck_gravity)) << ", DIRECTION=(0.0, 0.0, -1.0))\n# )\n\n"
      << "result = MECA_STATIQUE(\n    MODELE=model,\n    CHAM_MATER=material,\n    EXCIT=(\n        "
         "_F(CHARGE=clamp),\n"
         "        _F(CHARGE=load),\n        # _F(CHARGE=weight),\n    ),\n)\n"
      << "result = CALC_CHAMP(\n    reuse=result,\n    RESULTAT=result,\n    CONTRAINTE=(\"SIGM_ELNO\", "
         "\"SIGM_NOEU\"),\n"
         "    CRITERES=(\"SIEQ_ELNO\", \"SIEQ_NOEU\"),\n    FORCE=(\"REAC_NODA\",),\n)\n"
      << "reacs = POST_RELEVE_T(\n    ACTION=_F(\n        OPERATION=\"EXTRACTION\",\n        "
         "INTITULE=\"reactions\",\n"
         "        RESULTAT=result,\n        NOM_CHAM=\"REAC_NODA\",\n        GROUP_NO="
      << nodes << ",\n        RESULTANTE=(\"DX\", \"DY\", \"DZ\"),\n    )\n)\nIMPR_TABLE(TABLE=reacs, UNITE=8)\n"
      << "IMPR_RESU(\n    FORMAT=\"MED\",\n    UNITE=80,\n"
         "    RESU=_F(RESULTAT=result, NOM_CHAM=(\"DEPL\", \"SIGM_NOEU\", \"SIEQ_NOEU\", "
         "\"REAC_NODA\")),\n)\n\nFIN()\n";
}

void write_modal(std::ostream& out) {
  out << "\nASSEMBLAGE(\n    MODELE=model,\n    CHAM_MATER=material,\n    CHARGE=clamp,\n    "
         "NUME_DDL=CO(\"dofs\"),\n"
         "    MATR_ASSE=(\n        _F(MATRICE=CO(\"stiff\"), OPTION=\"RIGI_MECA\"),\n"
         "        _F(MATRICE=CO(\"mass\"), OPTION=\"MASS_MECA\"),\n    ),\n)\n"
      << "# ASSUMED: the lowest " << deck_modes << " modes\n"
      << "modes = CALC_MODES(\n    MATR_RIGI=stiff, MATR_MASS=mass, OPTION=\"PLUS_PETITE\", CALC_FREQ=_F(NMAX_FREQ="
      << deck_modes << ")\n)\n"
      << "freqs = RECU_TABLE(CO=modes, NOM_PARA=\"FREQ\")\nIMPR_TABLE(TABLE=freqs, UNITE=8)\n"
      << "IMPR_RESU(FORMAT=\"MED\", UNITE=80, RESU=_F(RESULTAT=modes, NOM_CHAM=\"DEPL\"))\n\nFIN()\n";
}

}  // namespace

std::string aster_deck(const DeckParts& parts) {
  std::ostringstream out;
  write_head(out, parts);
  write_material(out, parts);
  write_fixed(out, parts);
  if (parts.kind == DeckKind::modal)
    write_modal(out);
  else
    write_static(out, parts);
  return out.str();
}

}  // namespace scan2fea
