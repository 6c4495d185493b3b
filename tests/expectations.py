"""What the scripts among the tests expect, and what was wrong."""

wrong = []


def expect(condition, what):
    if not condition:
        wrong.append(what)
        print("wrong:", what)
