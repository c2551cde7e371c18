"""Which kernels of OpenBLAS are in use: those that suit the instructions of this processor, whether the library knows its model number or not."""

import pathlib

from support import *


def instructions():
    for line in pathlib.Path("/proc/cpuinfo").read_text().splitlines():
        if line.startswith("flags"):
            return set(line.partition(":")[2].split())
    return set()


class ProcessorTest(CliTest):
    def kernels(self, **environment):
        """What OpenBLAS says of itself each time it is loaded."""
        clean = {key: value for key, value in os.environ.items() if key != "OPENBLAS_CORETYPE"}
        answer = subprocess.run([program(), "check", "case.toml"], cwd=self.folder, capture_output=True, text=True,
                                env={**clean, "OPENBLAS_VERBOSE": "2", **environment})
        self.assertEqual(answer.returncode, 0, answer.stdout + answer.stderr)
        return re.findall(r"^Core: (\w+)", answer.stdout + answer.stderr, re.M)

    def test_they_suit_the_instructions(self):
        (self.folder / "case.toml").write_text(BASE)
        used = self.kernels()[-1]
        if instructions() >= {"avx2", "fma"}:
            self.assertNotIn(used, {"Prescott", "Nehalem", "Core2", "Generic"})
        if instructions() >= {"avx512f", "avx512cd", "avx512bw", "avx512dq", "avx512vl"}:
            self.assertIn(used, {"SkylakeX", "Cooperlake", "Sapphirerapids", "Zen"})

    def test_the_choice_of_the_user_is_kept(self):
        (self.folder / "case.toml").write_text(BASE)
        self.assertEqual(self.kernels(OPENBLAS_CORETYPE="Prescott"), ["Prescott"])


if __name__ == "__main__":
    main()
