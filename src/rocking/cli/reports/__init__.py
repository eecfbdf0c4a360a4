"""Printed reports of the commands."""
