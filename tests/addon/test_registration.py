import addon_utils

EXTENSION = "bl_ext.user_default.silhouette_mocap"


def test_the_extension_can_be_disabled_and_enabled_again_without_a_complaint(capsys):
    from bl_ext.user_default.silhouette_mocap.addon import cli

    for _ in range(2):
        assert addon_utils.check(EXTENSION) == (True, True)
        assert len(cli._handles) == 1
        addon_utils.disable(EXTENSION)
        assert addon_utils.check(EXTENSION)[1] is False
        assert cli._handles == []
        assert addon_utils.enable(EXTENSION) is not None
    assert "Exception" not in "".join(capsys.readouterr())
