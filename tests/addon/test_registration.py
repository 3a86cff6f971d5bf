import addon_utils

EXTENSION = "bl_ext.user_default.silhouette_mocap"


def test_the_extension_can_be_disabled_and_enabled_again():
    for _ in range(2):
        assert addon_utils.check(EXTENSION) == (True, True)
        addon_utils.disable(EXTENSION)
        assert addon_utils.check(EXTENSION)[1] is False
        assert addon_utils.enable(EXTENSION) is not None
