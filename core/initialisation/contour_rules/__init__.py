"""The skeleton from the contour: the rules of Jaume-i-Capó et al. 2012, made precise.

Each silhouette's contour becomes a B-spline whose creases, the minima of negative curvature, bound
the parts of the body. Cuts between creases give joints in every view, rays through them joints in
the world.
"""
