"""The pages on verification of the documentation."""


def write_manual(record, folder):
    folder.mkdir(parents=True)
    (folder / "index.md").write_text("# Verification\n\n[Soil, mesh, floor spectra and recorded motions](../verification.md): cases, references and tolerances.\n")
