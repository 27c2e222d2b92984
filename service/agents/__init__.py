"""What chat agents may do: six tools over the Model Context Protocol.

Only `endpoint` is imported at a start; the protocol's own package comes with the first request.
"""
