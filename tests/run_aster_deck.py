"""Executes a deck of Code_Aster, which is Python, with commands that only write down how they are called.

usage: run_aster_deck.py DECK.comm     prints one call a line: the command, then its keywords and values as JSON. Ends with
1 where something is used that no command made, or is given a name that is too long.
"""
import json
import sys


class Scope(dict):
    def __missing__(self, name):
        if name == "CO":
            return self.made
        if name == "_F":
            return lambda **keywords: keywords
        if not name.isupper():
            raise NameError(name)

        def command(**keywords):
            print(name, json.dumps(keywords))
            return "<" + name + ">"

        return command

    def __setitem__(self, name, value):
        assert len(name) <= 8, name  # all that Code_Aster takes
        super().__setitem__(name, value)

    def made(self, name):
        self[name] = "<" + name + ">"
        return self[name]


exec(compile(open(sys.argv[1]).read(), sys.argv[1], "exec"), {}, Scope())
