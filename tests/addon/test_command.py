import bpy
import pytest


def test_the_command_runs_the_same_words_and_returns_their_exit_codes(tmp_path, capsys):
    from bl_ext.user_default.silhouette_mocap.addon import cli

    assert cli._run(["info", str(tmp_path / "missing.toml")]) == 2
    assert "missing.toml" in capsys.readouterr().err


def test_blender_forgets_the_command_when_the_add_on_is_switched_off():
    from bl_ext.user_default.silhouette_mocap.addon import cli

    (handle,) = cli._handles
    cli.unregister()
    try:
        with pytest.raises(ValueError, match="already been removed"):
            bpy.utils.unregister_cli_command(handle)
    finally:
        cli.register()
