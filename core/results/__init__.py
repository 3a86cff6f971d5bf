"""What a fit leaves in its folder, while it runs and afterwards."""
