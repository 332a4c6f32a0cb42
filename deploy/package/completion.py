"""Makes bash's completion from the program's help: the tables of completion.bash."""
import pathlib
import re
import subprocess

TEMPLATE = pathlib.Path(__file__).with_name("completion.bash")
DEVICES = ["auto", "gpu", "cpu", "software", "cpu-double"]  # those without a number


def values_of(option):
    if option.name == "--device":
        return DEVICES
    return option.choices


def scenes(usages):
    """The scenes of the program, which the argument `scene` lists."""
    (serve,) = (usage for usage in usages if usage.words == ["serve"])
    (argument,) = (entry for entry in serve.groups["Positionals"] if entry.name == "scene")
    return argument.text.split("one of: ", 1)[1].split(", ")


def templates(binary):
    """The templates that `spherule scene new` lists."""
    done = subprocess.run([binary, "scene", "new"], capture_output=True, text=True, check=True)
    return re.findall(r"^([\w-]+) ", done.stdout, re.MULTILINE)


def control_commands(usage):
    """The first words of the commands that `spherule ctl --help` lists."""
    return sorted({word for line in usage.notes["Commands"] for word in re.findall(r"^ +([a-z_]+)\b", line)})


def table(name, rows):
    filled = [f'        ["{key}"]="{" ".join(values)}"' for key, values in rows.items()]
    return f"    {name}=(\n" + "\n".join(filled) + "\n    )"


def script(binary, usages):
    """Returns the text of the completion. A key of its tables is the command with its spaces and a slash."""
    commands, options, values, words = {}, {}, {}, {}
    for usage in usages:
        key = " ".join(usage.words) + "/"
        options[key] = [name for option in usage.options for name in option.names]
        if usage.commands:
            commands[key] = [command.name for command in usage.commands]
        if "scene" in (entry.name for entry in usage.groups.get("Positionals", [])):
            words[key] = scenes(usages)
        if usage.words == ["scene", "new"]:
            words[key] = templates(binary)
        if usage.words == ["ctl"]:
            words[key] = control_commands(usage)
        for option in usage.options:
            if option.value:
                values |= {name: values_of(option) for name in option.names}
    tables = "\n".join(table(name, rows) for name, rows in
                       (("commands", commands), ("options", options), ("values", values), ("words", words)))
    return TEMPLATE.read_text(encoding="utf-8").replace("@TABLES@ below", "The tables").replace("@TABLES@", tables)
