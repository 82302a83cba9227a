# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""scripts/sentences.py --comments reads the comments that it is for."""

import sys
import tempfile
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "scripts"))
import sentences


class Comments(unittest.TestCase):
    def read(self, name, text):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / name
            path.write_text(text)
            return [
                (first + line - 1, sentence)
                for first, prose in sentences.comments(path)
                for line, sentence, _ in sentences.sentences(prose)
            ]

    def test_rows_below_each_other_are_one_comment(self):
        text = '/// The force of\n/// a taxel. It is in newtons.\nfloat force = 0;  // no "//" here\n'
        self.assertEqual(self.read("one.hpp", text), [(1, "The force of a taxel."), (1, "It is in newtons.")])

    def test_a_label_beside_code_is_no_sentence(self):
        self.assertEqual(
            self.read("one.hpp", "float ohm;  ///< Of each line [ohm]\nfloat volts;  ///< Of each line.\n"), []
        )

    def test_a_sentence_beside_code_counts(self):
        text = (
            "float ohm;  ///< The line has this resistance from end\n"
            "            ///< to end.\n/// The next one.\nfloat volts;\n"
        )
        expected = [(1, "The line has this resistance from end to end."), (3, "The next one.")]
        self.assertEqual(self.read("one.hpp", text), expected)

    def test_texts_are_no_comments(self):
        self.assertEqual(
            self.read("one.cpp", 'auto url = "http://one.two three."; char quote = \'"\';  // Just one.\n'), []
        )

    def test_formulas_and_tables_are_left_out(self):
        text = "/// The law is\n///\n///   F = a + b z\n///\n/// for every taxel.\n"
        self.assertEqual(self.read("one.hpp", text), [(1, "The law is"), (5, "for every taxel.")])

    def test_comments_of_typescript_are_read(self):
        self.assertEqual(
            self.read("one.ts", "/**\n * Draws the map.\n * Once a frame.\n */\nconst a = `// no comment`;\n"),
            [(2, "Draws the map."), (2, "Once a frame.")],
        )

    def test_docstrings_and_comments_of_python_are_read(self):
        text = (
            'def read():\n    """Reads a file.\n\n    Once only."""\n\n'
            '    # The rest follows.\n    return "no docstring here."\n'
        )
        self.assertEqual(self.read("one.py", text), [(2, "Reads a file."), (4, "Once only."), (6, "The rest follows.")])


class Limits(unittest.TestCase):
    def judge(self, text):
        path = sentences.ROOT / "src" / "none.hpp"
        comments, sentences.comments = sentences.comments, lambda _: [(1, text)]
        try:
            return sentences.judge_comments([path], None)
        finally:
            sentences.comments = comments

    def test_long_sentences_fail(self):
        self.assertFalse(self.judge("The" + " word" * 30 + "."))

    def test_forty_one_sentences_that_begin_with_of_fail(self):
        self.assertFalse(self.judge("Of the line. " * 41))
        self.assertTrue(self.judge("Of the line. " * 40))


if __name__ == "__main__":
    unittest.main()
