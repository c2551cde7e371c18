"""The result documents follow their schemas (`uplift schema results`, `trust`, `motion`). Every summary that another test reads is checked too
(CliTest.summary)."""

import copy
import re

from support import *

EXAMPLES = pathlib.Path(__file__).resolve().parents[2] / "examples"


def members(schema, path=""):
    """(path, schema) of everything that a schema describes."""
    yield path, schema
    for key, inner in {**schema.get("properties", {}), **schema.get("$defs", {})}.items():
        yield from members(inner, f"{path}.{key}")
    for key in ("items", "additionalProperties"):
        if isinstance(schema.get(key), dict):
            yield from members(schema[key], path + "[]")


class Schemas(CliTest):
    def test_everything_is_described_and_every_number_has_a_unit(self):
        for document in ("results", "trust", "motion"):
            for path, schema in members(schema_of(document)):
                kinds = schema.get("type", "")
                is_constant = "const" in schema and path.endswith(".unit")  # the unit that a reference to a kind states
                if path and not path.endswith("[]") and not path.startswith(".number") and not is_constant:
                    self.assertTrue(schema.get("description"), f"{document}{path}")
                numeric = {"number", "integer"} & {kinds} if isinstance(kinds, str) else {"number", "integer"} & set(kinds)
                if numeric and not path.endswith("[]"):
                    self.assertTrue(schema.get("unit"), f"{document}{path}")
                if kinds == "object" and "additionalProperties" not in schema:
                    self.fail(f"{document}{path} accepts unknown keys")

    def test_unknown_names_of_schemas_are_refused(self):
        done = self.uplift("schema", "result", expect=2)
        self.assertIn('did you mean "results"?', done.stderr)

    def test_what_does_not_belong_is_found(self):
        """The check itself: a schema that accepted everything would pass the other tests."""
        self.write(BASE)
        self.uplift("run", "case.toml", "-o", "r", "-q")
        good = self.summary("r")

        def mistakes(change):
            summary = copy.deepcopy(good)
            change(summary)
            return list(violations(summary, schema_of("results"), schema_of("results")))

        self.assertEqual(mistakes(lambda s: None), [])
        self.assertEqual(mistakes(lambda s: s["runs"][0].update(colour="red")), ["$.runs[0]: colour is not in the schema"])
        self.assertEqual(mistakes(lambda s: s["runs"][0].pop("steps")), ["$.runs[0]: steps is missing"])
        self.assertEqual(mistakes(lambda s: s["runs"][0]["max_opening"].update(unit="mm")), ["$.runs[0].max_opening.unit: 'mm' is not 'm'"])
        self.assertEqual(mistakes(lambda s: s["runs"][0].update(steps=1.5)), ["$.runs[0].steps: 1.5 is not of type integer"])
        self.assertEqual(len(mistakes(lambda s: s["verdict"]["interfaces"][0]["numbers"]["max_moment"].update(unit="kN m"))), 1)
        self.assertEqual(len(mistakes(lambda s: s["verdict"]["numbers"].update(max_moment={}))), 1)


class Documents(CliTest):
    def test_examples(self):
        for case in sorted(EXAMPLES.glob("*/case.toml")):
            name, words = case.parent.name, []
            if sanitized() or name == "03_asymmetric_building":  # 40 s: for a fifteenth of its time, without the companion run
                case, words = self.shortened(case), ["--no-step-check"]
            self.uplift("run", case, "-o", name, "-q", *words)
            self.summary(name)

    def shortened(self, case):
        """The case with a fifteenth of every duration of a stage."""
        text, changed = re.subn(r'^duration = "(\d+) s"', lambda found: f"duration = {int(found[1]) / 15}", case.read_text(), flags=re.MULTILINE)
        self.assertGreater(changed, 0)
        return self.write(text)

    def test_trust_with_floors_and_beams(self):
        self.write(BASE.replace("bonded = false", "bonded = true") + '[[output.beam_envelope]]\nbeam = "column"\n'
                   '[[output.floor_spectrum]]\nname = "roof"\nnode = "top"\ndirection = [1, 0]\ndamping = [0.05]\n')
        self.uplift("trust", "case.toml", "-o", "r", "-q")
        summary = self.summary("r")
        self.assertTrue(summary["runs"][0]["floor_spectra"] and summary["runs"][0]["beam_envelopes"] and summary["verdict"]["beams"])
        trust = json.loads((self.folder / "r/trust.json").read_text())
        self.assertTrue(trust["spectra"])
        self.assert_valid(trust, "trust")

    def test_failed_runs_and_static_stages_alone(self):
        self.write(BASE.replace("[[stage]]", '[[load]]\nname = "push"\nnode = "top"\nforce = [9e6, 0]\n[[stage]]', 1))
        self.uplift("run", "case.toml", "-o", "failed", "-q", expect=3)
        self.assertEqual(self.summary("failed")["runs"][0]["status"], "failed")
        self.write(BASE.split('[[stage]]\ntype = "dynamic"')[0])
        self.uplift("run", "case.toml", "-o", "static", "-q")
        self.assertEqual(self.summary("static")["verdict"]["step_check"]["result"], "not made")

    def test_motions(self):
        self.uplift("motion", "--generate", "rg_1_60", "--generate", "rg_1_60", "pga=3", "duration=10", "seed=1", "-q", "-o", "m")
        document = json.loads((self.folder / "m/summary.json").read_text())
        self.assertEqual((len(document["fits"]), len(document["correlations"])), (2, 1))
        self.assert_valid(document, "motion")


if __name__ == "__main__":
    main()
